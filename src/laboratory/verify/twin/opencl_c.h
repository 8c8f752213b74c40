// The part of OpenCL C that the kernels' headers use with one lane, so that they compile as C++. Include it
// first.
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "shared/cull_params.h"
#include "shared/light_grid.h"
#include "verify/twin/twin.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"  // unread with some settings
#pragma GCC diagnostic ignored "-Wparentheses"       // OpenCL compilers do not require them
#define __OPENCL_VERSION__ 120                       // shared/cull_settings.h: the numbers, not the enums
#define global
#define constant const
#define LANES 1

namespace lightgrid::lab::verify {
namespace {

struct float2 {
  float x, y;
};

// OpenCL C's rule for NaN: the first argument, where the comparison is false.
template <typename T>
inline T min(T a, T b) {
  return b < a ? b : a;
}
template <typename T>
inline T max(T a, T b) {
  return a < b ? b : a;
}
inline float fabs(float x) { return std::fabs(x); }
inline float sqrt(float x) { return std::sqrt(x); }
inline float floor(float x) { return std::floor(x); }
inline int convert_int(float x) { return int(x); }
inline uint as_uint(float x) { return std::bit_cast<uint>(x); }
inline uint as_uint(int x) { return uint(x); }
inline float as_float(uint x) { return std::bit_cast<float>(x); }
inline uint clz(uint x) { return uint(std::countl_zero(x)); }

}  // namespace
}  // namespace lightgrid::lab::verify
