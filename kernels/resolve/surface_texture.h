// Filtered textures in OpenCL C, for LANES pixels that share a material: texels of 16 or 8 bits a channel,
// weighted as kernels/common/texture_footprint.h finds them.
//
// -DSMALL_TEXELS  packed texels have 8 bits a channel, not 16, and of base colours their square roots
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/common/texture_footprint.h"

#define TEXEL_STEP (1.0f / 65535.0f)

#if defined(AVX512) || defined(AVX2)
#define TEXELS_16(p) convert_float16(*(global const unaligned_ushorts*)(p))
#define TEXELS_8(p) convert_float8(*(global const unaligned_ushorts_8*)(p))
#elif LANES == 16
#define TEXELS_16(p) convert_float16(vload16(0, p))
#define TEXELS_8(p) convert_float8(vload8(0, p))
#else
// Texels are aligned to their size. vload does not know, and a GPU's compiler makes a load an element of it.
#define TEXELS_16(p) \
  convert_float16((ushort16)(((global const ushort8*)(p))[0], ((global const ushort8*)(p))[1]))
#define TEXELS_8(p) \
  convert_float8((ushort8)(((global const ushort4*)(p))[0], ((global const ushort4*)(p))[1]))
#endif

// Two packed texels (renderer/upload/scene_surfaces.h), and what a step of a channel is then worth.
#ifdef SMALL_TEXELS
typedef uchar packed_t;
#define PACKED_STEP (1.0f / 255.0f)
static inline float16 packed_texels(global const uchar* at) {
#if defined(AVX512) || defined(AVX2)
  const float16 t = convert_float16(*(global const unaligned_uchars*)at);
#elif LANES == 16
  const float16 t = convert_float16(vload16(0, at));
#else
  const float16 t = convert_float16((uchar16)(((global const uchar8*)at)[0], ((global const uchar8*)at)[1]));
#endif
  const float s = PACKED_STEP;
  const float16 of_colors = (float16)(s, s, s, 0, 0, 0, 0, 0, s, s, s, 0, 0, 0, 0, 0);
  const float16 of_others = (float16)(0, 0, 0, 1, 1, 1, 1, 1, 0, 0, 0, 1, 1, 1, 1, 1);
  return t * fma(t, of_colors, of_others);
}
#else
typedef ushort packed_t;
#define PACKED_STEP TEXEL_STEP
#define packed_texels(at) TEXELS_16(at)
#endif

// A trilinear filter takes these from a level: the numbers of the first texel of both rows, and weights. A
// texel's weight is its row's times its column's.
typedef struct LevelTaps {
  whole low, high;
  real low_weight, high_weight, left_weight, right_weight;
} LevelTaps;

// The same taps, which the compiler then has to read from memory, since it cannot know where a volatile
// pointer leads. There, one number for all lanes of an operand, or for an address, costs nothing; out of a
// vector that it holds in a register, each of them costs a shuffle. (Inline assembly would say the same, but
// PoCL 6 ends the process when it compiles any.)
static inline const LevelTaps* in_memory(const LevelTaps* taps) {
#if defined(AVX512) || defined(AVX2)
  const LevelTaps* volatile at = taps;
  return at;
#else
  return taps;
#endif
}

static inline LevelTaps level_taps(LevelFootprint f, real weight) {
  LevelTaps t;
  t.low = f.first;
  t.high = f.first + f.pitch;
  t.high_weight = weight * f.y;
  t.low_weight = weight - t.high_weight;
  t.left_weight = 1.0f - f.x;
  t.right_weight = f.x;
  return t;
}

// The sum and lane i's texels. Two texels of a row lie side by side.
static inline float8 add_texels_8(float8 sum, global const packed_t* chain, const LevelTaps* t, uint i) {
  const float16 low = packed_texels(chain + 8 * INDEX_LANE(t->low, i));
  const float16 high = packed_texels(chain + 8 * INDEX_LANE(t->high, i));
  const float16 pair = fma(high, (float16)(LANE(t->high_weight, i)), low * (float16)(LANE(t->low_weight, i)));
  return fma(pair.hi, (float8)(LANE(t->right_weight, i)),
             fma(pair.lo, (float8)(LANE(t->left_weight, i)), sum));
}

static inline float4 add_texels_4(float4 sum, global const ushort* chain, const LevelTaps* t, uint i) {
  const float8 low = TEXELS_8(chain + 4 * INDEX_LANE(t->low, i));
  const float8 high = TEXELS_8(chain + 4 * INDEX_LANE(t->high, i));
  const float8 pair = fma(high, (float8)(LANE(t->high_weight, i)), low * (float8)(LANE(t->low_weight, i)));
  return fma(pair.hi, (float4)(LANE(t->right_weight, i)),
             fma(pair.lo, (float4)(LANE(t->left_weight, i)), sum));
}

// Into sums, a lane each, what a footprint's texels weigh. The coarse level is not read where it counts
// nothing in any lane.
#define SUM_TEXELS(sums, TEXEL, ADD_TEXELS, chain, f)                                            \
  const bool two_levels = any_lane(f.mix > REAL(0.0f));                                          \
  const LevelTaps fine = level_taps(f.fine, 1.0f - f.mix), coarse = level_taps(f.coarse, f.mix); \
  const LevelTaps *fine_taps = in_memory(&fine), *coarse_taps = in_memory(&coarse);              \
  _Pragma("unroll") for (uint i = 0; i < LANES; ++i) {                                           \
    sums[i] = ADD_TEXELS((TEXEL)(0.0f), chain, fine_taps, i);                                    \
    if (two_levels) sums[i] = ADD_TEXELS(sums[i], chain, coarse_taps, i);                        \
  }

typedef struct Texels4 {
  real c[4];
} Texels4;

typedef struct Texels8 {
  real c[8];
} Texels8;

// Channels from 0 to 1. Weights may add up to a little more than 1.
static inline Texels4 filtered_4(global const ushort* texels, global const SurfaceMap* map,
                                 TexturePlace place) {
  const Footprint f = footprint_of(map, place);
  global const ushort* chain = texels + 4 * (size_t)map->base;
  float4 sums[LANES];
  SUM_TEXELS(sums, float4, add_texels_4, chain, f)
  Texels4 t;
  channels_of_pixels(t.c, sums);
  for (uint i = 0; i < 4; ++i) t.c[i] = lane_min(t.c[i] * TEXEL_STEP, REAL(1.0f));
  return t;
}

static inline Texels8 filtered_8(global const ushort* texels, global const SurfaceMap* map,
                                 const Footprint* footprint) {
  const Footprint f = *footprint;
  global const packed_t* chain = (global const packed_t*)texels + 8 * (size_t)map->base;
  float8 sums[LANES];
  SUM_TEXELS(sums, float8, add_texels_8, chain, f)
  Texels8 t;
  float4 low[LANES], high[LANES];
#pragma unroll
  for (uint i = 0; i < LANES; ++i) {
    low[i] = sums[i].lo;
    high[i] = sums[i].hi;
  }
  channels_of_pixels(t.c, low);
  channels_of_pixels(t.c + 4, high);
  for (uint i = 0; i < 8; ++i) t.c[i] = lane_min(t.c[i] * PACKED_STEP, REAL(1.0f));
  return t;
}
