// The lane type: tests are written once over `real`, LANES values wide (1 on a GPU, 16 on a CPU).
#pragma once

#ifndef LANES
#define LANES 1
#endif

#if LANES == 1
typedef float real;
typedef int whole;
typedef int mask_t;  // comparison results: 0 or 1
#define TO_WHOLE(x) convert_int(x)
#define TO_REAL(x) convert_float(x)
#elif LANES == 16
typedef float16 real;
typedef int16 whole;
typedef int16 mask_t;  // 0 or -1 a lane
#define TO_WHOLE(x) convert_int16(x)
#define TO_REAL(x) convert_float16(x)
#define LANE_INDEX ((int16)(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15))
#else
#error "LANES must be 1 or 16"
#endif

// a < b ? a : b compiles to one instruction on every device seen; fmin, which treats NaN apart, compiles to
// three. Where a is NaN the result is b.
static inline real lane_min(real a, real b) { return a < b ? a : b; }
static inline real lane_max(real a, real b) { return a > b ? a : b; }

#if LANES == 1
#define any_lane(m) ((m) != 0)
#endif

// Lane i of a variable.
#if LANES == 16
#define LANE(v, i) (((const float*)&(v))[i])
#define INDEX_LANE(v, i) ((size_t)((const uint*)&(v))[i])
#else
#define LANE(v, i) (v)
#define INDEX_LANE(v, i) ((size_t)(uint)(v))
#endif

// Sets each lane of a variable to `value`, an expression of the lane's number i that has the type `type`.
#if LANES == 16
#define SET_LANES(type, variable, value)                    \
  {                                                         \
    type lanes[16];                                         \
    for (uint i = 0; i < 16; ++i) lanes[i] = (type)(value); \
    variable = vload16(0, lanes);                           \
  }
#else
#define SET_LANES(type, variable, value) \
  {                                      \
    const uint i = 0;                    \
    variable = (type)(value);            \
  }
#endif

// The instruction set whose builtins kernels use: clang, and with it PoCL, says what it compiles for. -DPORTABLE
// uses none; the bytes are the same.
#if LANES == 16 && !defined(PORTABLE)
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define AVX512
#elif defined(__AVX2__)
#define AVX2
#endif
#endif

// One instruction, or two, where PoCL 3 has 14.
#if defined(AVX512)
#define ROUNDED(x, mode) __builtin_ia32_rndscaleps_mask((x), (mode), (x), (ushort)0xffff, 4)
#elif defined(AVX2)
#define ROUNDED(x, mode) \
  (float16)(__builtin_ia32_roundps256((x).lo, (mode)), __builtin_ia32_roundps256((x).hi, (mode)))
#endif
#ifdef ROUNDED
static inline real lane_floor(real x) { return ROUNDED(x, 9); }
static inline real lane_rint(real x) { return ROUNDED(x, 8); }
#else
#define lane_floor floor
#define lane_rint rint
#endif

// Position of the lowest set bit; ctz is missing from OpenCL C 1.2.
static inline uint lowest_bit(uint bits) { return 31u - clz(bits & (0u - bits)); }
