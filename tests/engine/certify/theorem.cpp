#include "certify/theorem.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>

namespace lightgrid::certify {

namespace {

Inputs inputs_of(const Meaning& meaning, std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(meaning.low, meaning.high);
  Inputs in;
  do
    for (const std::string& name : meaning.inputs) in[name] = any(random);
  while (!meaning.adjust(in));
  return in;
}

std::string values_differ(const Path& path, const Values& values, const Values& right,
                          const Meaning& meaning) {
  for (size_t i = 0; i < right.size(); ++i) {
    const long double found = values[size_t(path.results[i])];
    if (!(std::fabs(found - right[i]) <= meaning.tolerance * std::fabs(right[i]) + 1e-30L))
      return fmt::format("result {} means {}, not {}", i, double(found), double(right[i]));
  }
  return "";
}

}  // namespace

std::string meaning_differs(const std::vector<Path>& paths, const Meaning& meaning) {
  std::mt19937_64 random(1);
  for (int sample = 0; sample < meaning.samples; ++sample) {
    const Inputs in = inputs_of(meaning, random);
    const Values right = meaning.values(in);
    int taken = 0;
    for (const Path& path : paths) {
      const Values values = exact_values(path, in);
      if (!is_taken(path, values)) continue;
      ++taken;
      if (const std::string e = values_differ(path, values, right, meaning); !e.empty()) return e;
    }
    if (taken != 1) return fmt::format("{} paths are taken by one input", taken);
  }
  return "";
}

std::string meaning_differs(const Kernel& kernel, const Fault& fault, const Meaning& meaning) {
  std::mt19937_64 random(1);
  for (int sample = 0; sample < meaning.samples; ++sample) {
    const Inputs in = inputs_of(meaning, random);
    const auto decide = [&](const Choice& c) {
      const Path& path = recorder.path();
      Choice taken = c;
      taken.taken = true;
      return is_taken({.nodes = {}, .choices = {taken}, .results = {}}, exact_values(path, in));
    };
    const std::vector<Path> paths = paths_of(kernel, fault, decide);
    const std::string e = values_differ(paths[0], exact_values(paths[0], in), meaning.values(in), meaning);
    if (!e.empty()) return e;
  }
  return "";
}

std::string exceeds(const std::string& what, double value, double bound) {
  return value <= bound ? "" : fmt::format("{}: {} u, more than {} u", what, value / u, bound / u);
}

std::string exceeds(const std::string& what, const Polynomial& needed, const Polynomial& given) {
  return given.covers(needed) ? "" : fmt::format("{}: needs{} has{}", what, needed.text(), given.text());
}

float least_constant(const Proof& proof, float constant) {
  uint32_t fails = 0, holds = std::bit_cast<uint32_t>(constant);
  if (!proof({}).empty()) return std::numeric_limits<float>::infinity();
  while (holds - fails > 1) {
    const uint32_t middle = fails + (holds - fails) / 2;
    (proof({.constant = constant, .instead = std::bit_cast<float>(middle)}).empty() ? holds : fails) = middle;
  }
  return std::bit_cast<float>(holds);
}

Faults planted_faults(const Proof& proof) {
  Faults faults;
  const auto plant = [&](const Fault& fault, const std::string& name) {
    std::string reason;
    try {
      reason = proof(fault);
    } catch (const std::runtime_error& e) {
      reason = e.what();
    }
    if (!recorder.planted) return;
    ++faults.planted;
    if (reason.empty()) faults.survived.push_back(name);
  };
  proof({});
  const int operations = recorder.operations, comparisons = recorder.comparisons;
  for (int i = 0; i < operations; ++i)
    for (const char op : {'+', '-', '*'})
      plant({.operation = i, .op = op}, fmt::format("operation {} as {}", i, op));
  for (int i = 0; i < comparisons; ++i) plant({.comparison = i}, fmt::format("comparison {}", i));
  return faults;
}

}  // namespace lightgrid::certify
