// The part of OpenCL C that the headers in kernels/culling use with one lane, over Real; and these headers.
// Include it before any header of src/engine/shared.
#pragma once

#include <bit>
#include <cstdint>

#include "certify/real.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wparentheses"  // OpenCL compilers do not require them

namespace lightgrid::certify {
namespace {  // files choose their CULL_TEST

using uint = std::uint32_t;
template <typename T>
T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
T max(T a, T b) {
  return a < b ? b : a;
}
inline int convert_int(Real) { return 0; }  // a whole number is no result here: see `floor`
inline uint clz(uint x) { return uint(std::countl_zero(x)); }
inline uint as_uint(int x) { return uint(x); }
inline uint as_uint(Real) { return 0; }
// The depth whose key is 1 or 2: an input.
inline Real as_float(uint key) { return input("depth" + std::to_string(key)); }

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
#define SPOTS
#define float Real
#include "kernels/culling/depth_interval.h"
#include "kernels/culling/light_arrays.h"
#undef float
#undef constant
#undef global

}  // namespace
}  // namespace lightgrid::certify
