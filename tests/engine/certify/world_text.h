// kernels/world_grid/world_cells.h with one lane, over the `float` of the moment. Include it inside a namespace, after
// what it calls: min, max, fmax, floor, fabs, convert_int.
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-value"
#pragma GCC diagnostic ignored "-Wparentheses"

#define __OPENCL_VERSION__ 120
#define global
#define constant const
#define LANES 1
inline uint clz(uint x) { return uint(__builtin_clz(x)); }
struct float4 {
  float x, y, z, w;
};
struct uint2 {
  uint2(uint only) : x(only), y(0) {}  // a cast of a pair; no result here
  uint x, y;
};
inline uint atomic_add(volatile uint*, uint) { return 0; }
#include "kernels/world_grid/world_cells.h"
#undef constant
#undef global
