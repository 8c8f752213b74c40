// A theorem about a function of the kernels: a bound of its rounding error, and its exact meaning.
#pragma once

#include <string>
#include <vector>

#include "certify/forms.h"

namespace lightgrid::certify {

// "": proved; else why not.
using Proof = std::function<std::string(const Fault&)>;

// Bounds that one file proves and another one adds up.
constexpr double coordinate_error = 6.00001 * u;  // view_sphere, of the distance, for each coordinate
constexpr double box_slope_error = 4.00002 * u, box_offset_error = 5.00002 * u;  // a box's side
constexpr double distance_error = 5.00001 * u;                                   // a squared distance
constexpr double sphere_error = 5.0001 * u, sphere_middle_error = 2.0001 * u, half_error = 4.5001 * u;
constexpr double axis_error = 5.0001 * u, length_error = 3.5001 * u;          // of a cone
constexpr double section_f_error = 5.0001 * u, section_g_error = 5.0001 * u;  // of the exact test
constexpr double bound_fall_error = 2.0001 * u;
constexpr double along_error = 4.0001 * u, across_error = 3.0001 * u;

// Whether the exact values of the results, without roundings, are those of `meaning`, at many random inputs: each
// from `low` to `high`, which `adjust` may change. Algebraic expressions of low degree that agree there are equal.
using Values = std::vector<long double>;
struct Meaning {
  std::vector<std::string> inputs;
  std::function<Values(const Inputs&)> values;
  std::function<bool(Inputs&)> adjust = [](Inputs&) { return true; };  // false: other inputs
  double low = -2, high = 2;
  long double tolerance = 1e-12L;
  int samples = 300;
};
std::string meaning_differs(const std::vector<Path>& paths, const Meaning& meaning);
// The same for a function with too many paths: each sample runs it once, on the path that exact numbers take.
std::string meaning_differs(const Kernel& kernel, const Fault& fault, const Meaning& meaning);

// The reason, where a bound is not below another.
std::string exceeds(const std::string& what, double value, double bound);
std::string exceeds(const std::string& what, const Polynomial& needed, const Polynomial& given);

// Plants faults one at a time in the kernel: each operation replaced by others, each comparison with swapped operands.
// survived: the faults with which the proof still holds.
struct Faults {
  int planted = 0;
  std::vector<std::string> survived;
};
Faults planted_faults(const Proof& proof);

// A constant of the kernels under a fault; and the least float in its place with which the proof holds: with the next
// smaller one it does not.
inline double constant_of(double constant, const Fault& fault) {
  return constant == fault.constant && fault.instead != 0 ? fault.instead : constant;
}
float least_constant(const Proof& proof, float constant);

}  // namespace lightgrid::certify
