// A mask of 16 lanes as bits, and stores of the lanes that a mask keeps, in order: with builtins of AVX-512 or AVX2
// where the compiler has them (shared/lanes.h), else in plain OpenCL C.
#pragma once

#include "shared/lanes.h"

#if LANES == 16
#if defined(AVX512) || defined(AVX2)
// vload and vstore of these types become a move a lane in PoCL 3.
typedef float unaligned_floats __attribute__((ext_vector_type(16), aligned(4)));
typedef uint unaligned_uints __attribute__((ext_vector_type(16), aligned(4)));
typedef ushort unaligned_ushorts __attribute__((ext_vector_type(16), aligned(2)));
typedef ushort unaligned_ushorts_8 __attribute__((ext_vector_type(8), aligned(2)));
typedef uchar unaligned_uchars __attribute__((ext_vector_type(16), aligned(1)));
#endif

#if defined(AVX512)
static inline uint mask_bits(mask_t m) { return (ushort)__builtin_ia32_cvtd2mask512(m); }
static inline int16 packed(int16 v, uint bits) {
  return __builtin_ia32_compresssi512_mask(v, v, (ushort)bits);
}

// Each writes 16 values, the kept ones first. Lists therefore have room for 16 values past their end.
static inline void append_ushorts(global ushort* to, whole v, uint bits) {
  *(global unaligned_ushorts*)to = convert_ushort16(packed(v, bits));
}
static inline void append_uints(global uint* to, whole v, uint bits) {
  *(global unaligned_uints*)to = as_uint16(packed(v, bits));
}
#elif defined(AVX2)
typedef int unaligned_ints_8 __attribute__((ext_vector_type(8), aligned(4)));

// For each mask of 8 lanes the numbers of the lanes that it keeps, a byte each, the lowest first. pdep and pext
// would do without a table, but Zen 1 and 2 run them as microcode.
#define KEPT_0(above) above, (above) << 8
#define KEPT_1(above) KEPT_0(above), KEPT_0((above) << 8 | 1)
#define KEPT_2(above) KEPT_1(above), KEPT_1((above) << 8 | 2)
#define KEPT_3(above) KEPT_2(above), KEPT_2((above) << 8 | 3)
#define KEPT_4(above) KEPT_3(above), KEPT_3((above) << 8 | 4)
#define KEPT_5(above) KEPT_4(above), KEPT_4((above) << 8 | 5)
#define KEPT_6(above) KEPT_5(above), KEPT_5((above) << 8 | 6)
#define KEPT_7(above) KEPT_6(above), KEPT_6((above) << 8 | 7)
constant ulong kept_lanes[256] = {KEPT_7(0ul)};

static inline uint mask_bits(mask_t m) {
  return (uint)__builtin_ia32_movmskps256(as_float8(m.lo)) | (uint)__builtin_ia32_movmskps256(as_float8(m.hi))
                                                                 << 8;
}
static inline int8 packed(int8 v, uint bits) {
  return __builtin_ia32_permvarsi256(v, convert_int8(as_uchar8(kept_lanes[bits])));
}

static inline ushort8 packed_ushorts(ushort8 v, uint bits) {
  const uchar16 low = as_uchar16((ulong2)(kept_lanes[bits] << 1, 0ul)), high = low | (uchar)1;
  const uchar16 bytes =
      __builtin_shufflevector(low, high, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  return as_ushort8(__builtin_ia32_pshufb128(as_char16(v), as_char16(bytes)));
}

// Each writes 8 values, then 8 from the first free one on: at most 16. Lists therefore have room for 16 values
// past their end.
static inline void append_ushorts(global ushort* to, whole v, uint bits) {
  const uint low = bits & 0xffu;
  const ushort16 u = __builtin_convertvector(v, ushort16);
  *(global unaligned_ushorts_8*)to = packed_ushorts(u.lo, low);
  *(global unaligned_ushorts_8*)(to + popcount(low)) = packed_ushorts(u.hi, bits >> 8);
}
static inline void append_uints(global uint* to, whole v, uint bits) {
  const uint low = bits & 0xffu;
  *(global unaligned_ints_8*)to = packed(v.lo, low);
  *(global unaligned_ints_8*)(to + popcount(low)) = packed(v.hi, bits >> 8);
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
#define APPEND_LANES(WRITE)                              \
  _Pragma("unroll") for (uint h = 0; h < 16; h += 8) {   \
    uint n = h == 0 ? 0u : popcount(bits & 0xffu);       \
    _Pragma("unroll") for (uint i = h; i < h + 8; ++i) { \
      WRITE;                                             \
      n += bits >> i & 1u;                               \
    }                                                    \
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
#undef APPEND_LANES
#endif
static inline void append_reals(global float* to, real v, uint bits) {
  append_uints((global uint*)to, as_int16(v), bits);
}

// The bits of a & b, and those of the first n lanes.
#if defined(AVX512) || defined(AVX2)  // one by one: from a and b joined LLVM makes bytes with AVX2
#define bits_of_both(a, b) (mask_bits(a) & mask_bits(b))
#else
#define bits_of_both(a, b) mask_bits((a) & (b))
#endif
static inline uint first_lanes(uint n) { return n < 16 ? (1u << n) - 1u : 0xffffu; }
#define any_lane(m) (mask_bits(m) != 0)
#endif
