// A mask of 16 lanes as bits, and stores of the lanes that a mask keeps, in order. With -DAVX512 each is one
// instruction, through builtins of the compiler; without it, plain OpenCL C.
#pragma once

#include "shared/lanes.h"

#if LANES == 16
#ifdef AVX512
typedef float unaligned_floats __attribute__((ext_vector_type(16), aligned(4)));
typedef ushort unaligned_ushorts __attribute__((ext_vector_type(16), aligned(2)));
typedef uint unaligned_uints __attribute__((ext_vector_type(16), aligned(4)));

static inline uint mask_bits(mask_t m) { return (ushort)__builtin_ia32_cvtd2mask512(m); }
static inline int16 packed(int16 v, uint bits) {
  return __builtin_ia32_compresssi512_mask(v, v, (ushort)bits);
}

// Each writes 16 values, the kept ones first. Lists therefore have room for 16 values past their end.
static inline void append_reals(global float* to, real v, uint bits) {
  *(global unaligned_floats*)to = as_float16(packed(as_int16(v), bits));
}
static inline void append_ushorts(global ushort* to, whole v, uint bits) {
  *(global unaligned_ushorts*)to = convert_ushort16(packed(v, bits));
}
static inline void append_uints(global uint* to, whole v, uint bits) {
  *(global unaligned_uints*)to = as_uint16(packed(v, bits));
}
static inline void append_uints_3(global uint* to, size_t stride, whole a, whole b, whole c, uint bits) {
  append_uints(to, a, bits), append_uints(to + stride, b, bits), append_uints(to + 2 * stride, c, bits);
}
#else
static inline uint mask_bits(mask_t m) {
  const int16 b = m & (int16)(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024, 2048, 4096, 8192, 16384, 32768);
  const int8 c = b.lo | b.hi;
  const int4 d = c.lo | c.hi;
  const int2 e = d.lo | d.hi;
  return (uint)(e.x | e.y);
}

// As above. Every lane is written to the next free entry, which advances only for kept lanes: cheaper than a
// branch. The upper half starts from its own count and does not wait for the lower half.
#define APPEND_LANES(WRITE)                                         \
  _Pragma("unroll") for (uint h = 0; h < 16; h += 8) {              \
    uint n = h == 0 ? 0u : popcount(bits & 0xffu);                  \
    _Pragma("unroll") for (uint i = h; i < h + 8; ++i) {            \
      WRITE;                                                        \
      n += bits >> i & 1u;                                          \
    }                                                               \
  }
static inline void append_ushorts(global ushort* to, whole v, uint bits) {
  int lanes[16];
  vstore16(v, 0, lanes);
  APPEND_LANES(to[n] = (ushort)lanes[i])
}
static inline void append_uints(global uint* to, whole v, uint bits) {
  int lanes[16];
  vstore16(v, 0, lanes);
  APPEND_LANES(to[n] = (uint)lanes[i])
}
static inline void append_uints_3(global uint* to, size_t stride, whole a, whole b, whole c, uint bits) {
  int lanes[3][16];
  vstore16(a, 0, lanes[0]), vstore16(b, 0, lanes[1]), vstore16(c, 0, lanes[2]);
  APPEND_LANES(
      (to[n] = (uint)lanes[0][i], to[stride + n] = (uint)lanes[1][i], to[2 * stride + n] = (uint)lanes[2][i]))
}
#undef APPEND_LANES
#endif
#define any_lane(m) (mask_bits(m) != 0)
#endif
