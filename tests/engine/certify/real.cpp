#include "certify/real.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lightgrid::certify {
namespace {

bool holds(long double a, char op, long double b) {
  switch (op) {
    case '<':
      return a < b;
    case '>':
      return a > b;
    case 'l':
      return a <= b;
    case 'g':
      return a >= b;
    default:
      return a == b;
  }
}

template <typename T>
T result_of(char op, T a, T b) {
  switch (op) {
    case '+':
      return a + b;
    case '-':
      return a - b;
    case '*':
      return a * b;
    case '/':
      return a / b;
    case 's':
      return std::sqrt(a);
    case 'a':
      return std::fabs(a);
    case 'n':
      return -a;
    case 'r':
      return a;
    default:
      return std::floor(a);
  }
}

}  // namespace

// Operations on constants are computed, in float. x + 0, x - 0 and x * 1 are x; x - x and x * 0
// are 0, as inputs are finite.
int Recorder::add(Node n) {
  const auto constant = [&](int id, double value) { return node(id).op == 'c' && node(id).value == value; };
  if (n.op == 'c' && n.value == fault_.constant && fault_.instead != 0) n.value = fault_.instead;
  if (n.a >= 0 && node(n.a).op == 'c' && (n.b < 0 || node(n.b).op == 'c')) {
    const float a = float(node(n.a).value), b = n.b < 0 ? 0 : float(node(n.b).value);
    n = {.op = 'c', .value = double(result_of(n.op, a, b)), .name = ""};
  }
  if ((n.op == '+' || n.op == '-') && constant(n.b, 0)) return n.a;
  if (n.op == '+' && constant(n.a, 0)) return n.b;
  if (n.op == '*' && constant(n.b, 1)) return n.a;
  if (n.op == '*' && (constant(n.a, 0) || constant(n.b, 0))) n = {.op = 'c', .name = ""};
  if (n.op == '-' && n.a == n.b) n = {.op = 'c', .name = ""};
  bool changed = false;
  if (n.a >= 0 && n.op != 'r' && observed && operations_++ == fault_.operation) {
    const char op = n.b >= 0 ? fault_.op : fault_.op == '-' ? (n.op == 'n' ? 'a' : 'n') : n.op;
    changed = op != n.op;
    n.op = op;
  }
  const auto [at, added] = known_.try_emplace({n.op, n.a, n.b, n.value, n.name}, int(path_.nodes.size()));
  if (added) path_.nodes.push_back(n);
  if (changed) path_.faulty = at->second;
  operations = std::max(operations, operations_);
  return at->second;
}

bool Recorder::compare(int a, char op, int b) {
  if (node(a).op == 'c' && node(b).op == 'c') return holds(node(a).value, op, node(b).value);
  bool faulty = false;
  if (observed && comparisons_++ == fault_.comparison) {
    std::swap(a, b);
    faulty = true;
  }
  comparisons = std::max(comparisons, comparisons_);
  Choice choice{a, op, b, false, faulty};
  if (const std::optional<bool> decided = decide ? decide(choice) : std::nullopt) {
    choice.taken = *decided;
  } else {
    for (Choice& c : path_.choices)
      if (c.a == a && c.op == op && c.b == b) {
        c.faulty |= faulty;
        return c.taken;
      }
    if (taken_ == outcomes_.size()) outcomes_.push_back(false);
    choice.taken = outcomes_[taken_++];
  }
  path_.choices.push_back(choice);
  return choice.taken;
}

void Recorder::begin() {
  path_ = {};
  known_.clear();
  operations_ = comparisons_ = 0;
  taken_ = 0;
}

bool Recorder::next() {
  outcomes_.resize(taken_);
  while (!outcomes_.empty() && outcomes_.back()) outcomes_.pop_back();
  if (outcomes_.empty()) return false;
  outcomes_.back() = true;
  return true;
}

// Whether a comparison is faulty, or the faulty node is part of a result or of a number that is compared.
static bool has_effect(const Path& path) {
  if (std::any_of(path.choices.begin(), path.choices.end(), [](const Choice& c) { return c.faulty; }))
    return true;
  if (path.faulty < 0) return false;
  std::vector<bool> used(path.nodes.size());
  for (const int id : path.results) used[size_t(id)] = true;
  for (const Choice& c : path.choices) used[size_t(c.a)] = used[size_t(c.b)] = true;
  for (size_t i = path.nodes.size(); i-- > 0;)
    for (const int operand : {path.nodes[i].a, path.nodes[i].b})
      if (used[i] && operand >= 0) used[size_t(operand)] = true;
  return used[size_t(path.faulty)];
}

std::vector<Path> paths_of(const Kernel& kernel, const Fault& fault, const Recorder::Decide& decide) {
  std::vector<Path> paths;
  recorder = Recorder(fault);
  recorder.decide = decide;
  do {
    if (paths.size() == 1000) throw std::runtime_error("more paths than the kernel has");  // faulty loops
    recorder.begin();
    std::vector<int> results;
    for (const Real r : kernel()) results.push_back(r.id);
    paths.push_back(recorder.path());
    paths.back().results = results;
    recorder.planted |= has_effect(paths.back());
  } while (recorder.next());
  return paths;
}

std::vector<long double> exact_values(const Path& path, const Inputs& inputs) {
  std::vector<long double> values;
  values.reserve(path.nodes.size());
  for (const Node& n : path.nodes) {
    if (n.op == 'c')
      values.push_back(n.value);
    else if (n.op == 'i')
      values.push_back(inputs.at(n.name));
    else
      values.push_back(result_of(n.op, values[size_t(n.a)], n.b < 0 ? 0 : values[size_t(n.b)]));
  }
  return values;
}

bool is_taken(const Path& path, const std::vector<long double>& values) {
  for (const Choice& c : path.choices)
    if (holds(values[size_t(c.a)], c.op, values[size_t(c.b)]) != c.taken) return false;
  return true;
}

}  // namespace lightgrid::certify
