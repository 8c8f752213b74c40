// Numbers that record how they were computed. The kernels' headers compile as C++ with `float` replaced by Real
// (kernel_text.h), so one run of a kernel's function gives the expression of each result. A comparison of Reals
// takes both outcomes, one run each: paths_of returns every path through the function.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "certify/polynomial.h"

namespace lightgrid::certify {

// op: i input, c constant, + - * /, s square root, a absolute value, n negative, f floor, r a double rounded to a float.
struct Node {
  char op;
  int a = -1, b = -1;     // operands
  double value = 0;       // of a constant
  std::string name = "";  // of an input; "double": an operation of doubles
};

// A comparison and its outcome. op: < > l (<=) g (>=) =.
struct Choice {
  int a;
  char op;
  int b;
  bool taken;
  bool faulty = false;  // with swapped operands
};

struct Path {
  std::vector<Node> nodes;  // operands before the nodes that use them; equal expressions are one node
  std::vector<Choice> choices;
  std::vector<int> results;
  // Lemmas, by node: forms of inputs and of nodes that are bounded more tightly than by their operands; signs.
  std::map<int, Form> forms{};
  std::map<int, int> signs{};
  int faulty = -1;  // the node of a planted fault
};

// A planted fault: another operation in place of one, which is given by its number in the order of execution on a path;
// a comparison with swapped operands; or another value of a constant.
struct Fault {
  int operation = -1;
  char op = 0;
  int comparison = -1;
  double constant = 0, instead = 0;
};

class Recorder {
 public:
  explicit Recorder(const Fault& fault = {}) : fault_(fault) {}
  int add(Node node);
  bool compare(int a, char op, int b);
  const Node& node(int id) const { return path_.nodes[size_t(id)]; }
  void begin();
  bool next();  // the next path; false after the last one
  // The outcome of a comparison that takes one only: no theorem needs the other, or another run has it.
  using Decide = std::function<std::optional<bool>(const Choice&)>;
  Decide decide = nullptr;
  Path& path() { return path_; }
  bool observed = true;  // false: what is recorded is no part of the kernel and gets no fault
  bool planted = false;  // the fault changes a result or a comparison
  int operations = 0;    // the most of a path
  int comparisons = 0;   // likewise

 private:
  Fault fault_{};
  int operations_ = 0, comparisons_ = 0;
  Path path_;
  std::map<std::tuple<char, int, int, double, std::string>, int> known_;
  std::vector<bool> outcomes_;  // of comparisons that take both
  size_t taken_ = 0;            // likewise
};
inline Recorder recorder;

class Real {
 public:
  Real() = default;
  Real(double c) : id(recorder.add({.op = 'c', .value = double(static_cast<float>(c))})) {}
  Real(float c) : Real(double(c)) {}
  Real(int c) : Real(double(c)) {}
  Real(unsigned c) : Real(double(c)) {}
  explicit operator unsigned() const { return unsigned(recorder.node(id).value); }  // of a constant
  int id = -1;
};

inline Real of(int id) {
  Real r;
  r.id = id;
  return r;
}
inline Real input(const std::string& name) { return of(recorder.add({.op = 'i', .name = name})); }
inline Real operator+(Real a, Real b) { return of(recorder.add({'+', a.id, b.id})); }
inline Real operator-(Real a, Real b) { return of(recorder.add({'-', a.id, b.id})); }
inline Real operator*(Real a, Real b) { return of(recorder.add({'*', a.id, b.id})); }
inline Real operator/(Real a, Real b) { return of(recorder.add({'/', a.id, b.id})); }
inline Real operator-(Real a) { return of(recorder.add({'n', a.id})); }
inline Real sqrt(Real a) { return of(recorder.add({'s', a.id})); }
inline Real fabs(Real a) { return of(recorder.add({'a', a.id})); }
inline Real floor(Real a) { return of(recorder.add({'f', a.id})); }
inline int operator<(Real a, Real b) { return recorder.compare(a.id, '<', b.id); }
inline int operator>(Real a, Real b) { return recorder.compare(a.id, '>', b.id); }
inline int operator<=(Real a, Real b) { return recorder.compare(a.id, 'l', b.id); }
inline int operator>=(Real a, Real b) { return recorder.compare(a.id, 'g', b.id); }
inline int operator==(Real a, Real b) { return recorder.compare(a.id, '=', b.id); }
inline int operator!=(Real a, Real b) { return !(a == b); }

// While it lives, expressions only name the kernel's nodes.
struct Naming {
  Naming() { recorder.observed = false; }
  ~Naming() { recorder.observed = true; }
};

inline void give(Real x, const Form& form) { recorder.path().forms[x.id] = form; }
inline void give_sign(Real x, int sign) { recorder.path().signs[x.id] = sign; }

// Every path of a function from inputs to results.
using Kernel = std::function<std::vector<Real>()>;
std::vector<Path> paths_of(const Kernel& kernel, const Fault& fault = {},
                           const Recorder::Decide& decide = nullptr);

// The exact value of each node, without roundings; and whether the inputs take the path.
using Inputs = std::map<std::string, long double>;
std::vector<long double> exact_values(const Path& path, const Inputs& inputs);
bool is_taken(const Path& path, const std::vector<long double>& values);

}  // namespace lightgrid::certify
