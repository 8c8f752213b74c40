// The part of OpenCL C that the headers of light cells use with one lane, over Real for float and Wide for double;
// and these headers. Include it before any header of src/engine/shared.
#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>

#include "certify/real.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"

namespace lightgrid::certify {
namespace {

// A double: its operations are other nodes than those of floats, and so is its rounding to a float.
class Double {
 public:
  Double() = default;
  Double(double c) : id(Real(c).id) {}
  Double(int c) : id(Real(c).id) {}
  Double(Real x) : id(x.id) {}
  explicit operator Real() const { return of(recorder.add({.op = 'r', .a = id})); }
  int id = -1;
};
Double wide(char op, Double a, Double b = {}) {
  Double d;
  d.id = recorder.add({.op = op, .a = a.id, .b = b.id, .name = "double"});
  return d;
}
Double operator+(Double a, Double b) { return wide('+', a, b); }
Double operator-(Double a, Double b) { return wide('-', a, b); }
Double operator*(Double a, Double b) { return wide('*', a, b); }
Double operator-(Double a) { return wide('n', a); }
int operator<(Double a, Double b) { return recorder.compare(a.id, '<', b.id); }
int operator>(Double a, Double b) { return recorder.compare(a.id, '>', b.id); }
int operator!=(Double a, Double b) { return !recorder.compare(a.id, '=', b.id); }

using uint = std::uint32_t;
using ulong = std::uint64_t;
struct uint2 {
  uint2(uint only) : x(only), y(0) {}
  uint x, y;
};
struct uint4 {
  uint x, y, z, w;
};
struct float4 {
  Real x, y, z, w;
};
Real& operator+=(Real& a, Real b) { return a = a + b; }
Real& operator-=(Real& a, Real b) { return a = a - b; }
Real fmax(Real a, Real b) { return a > b ? a : b; }
// Rounded once; bounds are for two roundings, which are more.
Real fma(Real a, Real b, Real c) { return a * b + c; }
uint clz(uint x) { return uint(std::countl_zero(x)); }
int popcount(uint x) { return std::popcount(x); }
template <typename T>
T min(T a, T b) {
  return b < a ? b : a;
}
int as_int(Real) { return 0; }
uint as_uint(Real) { return 0; }
Real as_float(uint) { return 0; }

// What is converted to whole numbers. A conversion returns how many came before it.
std::vector<Real> converted;
int convert_int(Real x) {
  if (converted.size() == 8)
    throw std::runtime_error("more conversions than the kernel has");  // faulty loops
  converted.push_back(x);
  return int(converted.size()) - 1;
}
uint atomic_inc(volatile uint* at) {
  const uint before = *at;
  *at = before + 1;
  return before;
}

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
#define float Real
#define double Double
#include "kernels/rays/light_cell_lists.h"
#include "kernels/rays/light_cells.h"
#undef double
#undef float
#undef constant
#undef global

}  // namespace
}  // namespace lightgrid::certify
