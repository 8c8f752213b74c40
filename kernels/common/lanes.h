// The lane type: kernels are written once over `real`, LANES values wide (1 on a GPU, 8 or 16 on a CPU).
#pragma once

#ifndef LANES
#define LANES 1
#endif

#if LANES == 1
typedef float real;
typedef int mask_t;  // comparison results: 0 or 1
#define LOAD(p) (*(p))
#define LANE_INDEX 0
// Comparisons of scalars give 1, of vectors -1: both select with ?:.
static inline uint mask_bits(mask_t m) { return (uint)(m & 1); }
#else
#define CONCAT_(a, b) a##b
#define CONCAT(a, b) CONCAT_(a, b)
typedef CONCAT(float, LANES) real;
typedef CONCAT(int, LANES) mask_t;
#define LOAD(p) CONCAT(vload, LANES)(0, p)
#if LANES == 16
#define LANE_INDEX ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#define LANE_BIT ((int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768))
static inline uint mask_bits(mask_t m) {
  int16 b = m & LANE_BIT;
  int8 c = b.lo | b.hi;
  int4 d = c.lo | c.hi;
  int2 e = d.lo | d.hi;
  return (uint)(e.x | e.y);
}
#elif LANES == 8
#define LANE_INDEX ((int8)(0, 1, 2, 3, 4, 5, 6, 7))
#define LANE_BIT ((int8)(1, 2, 4, 8, 16, 32, 64, 128))
static inline uint mask_bits(mask_t m) {
  int8 b = m & LANE_BIT;
  int4 d = b.lo | b.hi;
  int2 e = d.lo | d.hi;
  return (uint)(e.x | e.y);
}
#else
#error "LANES must be 1, 8 or 16"
#endif
#endif

// a < b ? a : b compiles to one instruction on every device seen; fmin, which must care for NaN, to three.
static inline real lane_min(real a, real b) { return a < b ? a : b; }
static inline real lane_max(real a, real b) { return a > b ? a : b; }

// Position of the lowest set bit; ctz is missing from OpenCL C 1.2.
static inline uint lowest_bit(uint bits) { return 31u - clz(bits & (0u - bits)); }
