// Filtered textures in OpenCL C, for LANES pixels that share a material: mip chains as renderer/texel_chain.h
// lays them out, with OpenGL's wrap modes, magnification and minification filters (OpenGL 4.6, 8.14). The
// level of detail comes from exact derivatives, not from differences between pixels. Arithmetic is IEEE's
// alone, and so the same on every device.
//
// -DSMALL_TEXELS  packed texels have 8 bits a channel, not 16, and of base colours their square roots
#pragma once

#include "kernels/common/pack.h"
#include "shared/real.h"
#include "shared/surface_records.h"

// Texture coordinates, and how much they change a pixel to the right and a pixel up.
typedef struct TexturePlace {
  real u, v, u_right, v_right, u_up, v_up;
} TexturePlace;

// The 2 x 2 texels of one level that a filter takes: the first one's number in the chain, texels from row to
// row, and the place between them.
typedef struct LevelFootprint {
  whole first, pitch;
  real x, y;
} LevelFootprint;

typedef struct Footprint {
  LevelFootprint fine, coarse;
  real mix;  // 0: fine alone
} Footprint;

#if LANES == 16
#define UNSIGNED_MIN(a, b) as_int16(min(as_uint16(a), as_uint16(b)))
#else
#define UNSIGNED_MIN(a, b) as_int(min(as_uint(a), as_uint(b)))
#endif
static inline whole as_whole_of(real x) {
#if LANES == 16
  return as_int16(x);
#else
  return as_int(x);
#endif
}
static inline real as_real_of(whole x) {
#if LANES == 16
  return as_float16(x);
#else
  return as_float(x);
#endif
}

// To 3.1e-4 for normal numbers; exact for powers of two.
static inline real rough_log2(real x) {
  const whole bits = as_whole_of(x);
  const real exponent = TO_REAL((bits >> 23) - 127), t = as_real_of((bits & 0x7fffff) | 0x3f800000) - 1.0f;
  const real bend = fma(fma(REAL(0.08161574f), t, REAL(-0.24266946f)), t, REAL(0.44078080f));
  return exponent + fma(t * (1.0f - t), bend, t);
}

// A coordinate folded into one copy of the texture: 0 to 1. Clamped ones are left to texel_of.
static inline real folded(real x, uint clamped, uint mirrored) {
  if (clamped) return x;
  if (!mirrored) return x - lane_floor(x);
  return 1.0f - fabs(fma(REAL(-2.0f), lane_floor(x * 0.5f), x) - 1.0f);
}

// The first of the two texels along an axis, and the place between them. What is not finite finds a texel
// too.
static inline whole texel_of(real coordinate, whole size, uint repeated, mask_t nearest, real* between) {
  const real sizes = TO_REAL(size);
  real x = fma(coordinate, sizes, nearest ? REAL(0.0f) : REAL(-0.5f));
  if (!repeated) x = lane_min(lane_max(x, REAL(0.0f)), sizes - 1.0f);
  const real first = lane_floor(x);
  *between = nearest ? REAL(0.0f) : x - first;
  return UNSIGNED_MIN(TO_WHOLE(first),
                      size - 1);  // repeated, -1 is the last texel, beside which the first lies once more
}

static inline whole first_of_level(global const SurfaceMap* map, whole level) {
#if LANES == 1
  return (int)map->level_first[level];
#elif defined(AVX512)
  return __builtin_ia32_permvarsi512(as_int16(*(global const unaligned_uints*)map->level_first), level);
#else
  const int* levels = (const int*)&level;
  int16 first;
  int* to = (int*)&first;
  for (int i = 0; i < 16; ++i) to[i] = (int)map->level_first[levels[i]];
  return first;
#endif
}

static inline LevelFootprint footprint_in_level(global const SurfaceMap* map, whole level, real u, real v,
                                                mask_t nearest) {
  const whole one = 1, columns = max((whole)((int)map->width) >> level, one),
              rows = max((whole)((int)map->height) >> level, one);
  const uint flags = map->flags;
  LevelFootprint f;
  const whole x = texel_of(u, columns, !(flags & (MAP_CLAMP_U | MAP_MIRROR_U)), nearest, &f.x);
  const whole y = texel_of(v, rows, !(flags & (MAP_CLAMP_V | MAP_MIRROR_V)), nearest, &f.y);
  f.pitch = columns + 1;
  f.first = first_of_level(map, level) + y * f.pitch + x;
  return f;
}

// uv0, uv1: by texture coordinate set. KHR_texture_transform turns the derivatives too.
static inline TexturePlace place_in_map(global const SurfaceMap* map, TexturePlace p) {
  if (!(map->flags & MAP_TRANSFORM)) return p;
  const float a = map->uv_linear[0], b = map->uv_linear[1], c = map->uv_linear[2], d = map->uv_linear[3];
  const TexturePlace q = {a * p.u + c * p.v + map->uv_offset[0],
                          b * p.u + d * p.v + map->uv_offset[1],
                          a * p.u_right + c * p.v_right,
                          b * p.u_right + d * p.v_right,
                          a * p.u_up + c * p.v_up,
                          b * p.u_up + d * p.v_up};
  return q;
}

static inline __attribute__((always_inline)) Footprint footprint_of(global const SurfaceMap* map,
                                                                    TexturePlace place) {
  const TexturePlace p = place_in_map(map, place);
  const float width = (float)map->width, height = (float)map->height;
  const uint flags = map->flags;
  const real ax = p.u_right * width, ay = p.v_right * height, bx = p.u_up * width, by = p.v_up * height;
  const real longest = lane_max(fma(ax, ax, ay * ay), fma(bx, bx, by * by));
  const real lod = 0.5f * rough_log2(lane_min(lane_max(longest, REAL(0x1p-60f)), REAL(0x1p60f)));
  mask_t nearest = (mask_t)(0);
  if (flags & (MAP_MAGNIFY_NEAREST | MAP_MINIFY_NEAREST)) {
    const mask_t minified = lod > REAL(0.0f), magnified = lod <= REAL(0.0f);
    if (flags & MAP_MINIFY_NEAREST) nearest |= minified;
    if (flags & MAP_MAGNIFY_NEAREST) nearest |= magnified;
  }
  real level = lane_min(lane_max(lod, REAL(0.0f)), REAL((float)map->last_level));
  if (flags & MAP_LEVEL_NEAREST) level = lane_floor(level + 0.5f);
  const real fine = lane_floor(level);
  const whole fine_level = TO_WHOLE(fine);
  const real u = folded(p.u, flags & MAP_CLAMP_U, flags & MAP_MIRROR_U);
  const real v = folded(p.v, flags & MAP_CLAMP_V, flags & MAP_MIRROR_V);
  Footprint f;
  f.mix = level - fine;
  f.fine = footprint_in_level(map, fine_level, u, v, nearest);
  f.coarse = footprint_in_level(map, min(fine_level + 1, (whole)((int)map->last_level)), u, v, nearest);
  return f;
}

// --- Texels of 16 bits a channel
// -------------------------------------------------------------------------------------

#define TEXEL_STEP (1.0f / 65535.0f)

#if defined(AVX512) && LANES == 16
typedef ushort unaligned_ushorts_8 __attribute__((ext_vector_type(8), aligned(2)));
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

// Two packed texels (renderer/surface_texels.h), and what a step of a channel is then worth.
#ifdef SMALL_TEXELS
typedef uchar packed_t;
#define PACKED_STEP (1.0f / 255.0f)
static inline float16 packed_texels(global const uchar* at) {
#if defined(AVX512) && LANES == 16
  typedef uchar unaligned_uchars __attribute__((ext_vector_type(16), aligned(1)));
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

// x and x + 1 lie side by side.
static inline float8 bilinear_8(global const packed_t* at, size_t pitch, float x, float y) {
  const float16 low = packed_texels(at), high = packed_texels(at + 8 * pitch);
  const float16 row = fma(high - low, (float16)(y), low);
  return fma(row.hi - row.lo, (float8)(x), row.lo);
}

static inline float4 bilinear_4(global const ushort* at, size_t pitch, float x, float y) {
  const float8 low = TEXELS_8(at), high = TEXELS_8(at + 4 * pitch);
  const float8 row = fma(high - low, (float8)(y), low);
  return fma(row.hi - row.lo, (float4)(x), row.lo);
}

// One lane of each member of a footprint.
#if LANES == 16
#define LANE(v, i) (((const float*)&(v))[i])
#define INDEX_LANE(v, i) ((size_t)((const uint*)&(v))[i])
#else
#define LANE(v, i) (v)
#define INDEX_LANE(v, i) ((size_t)(uint)(v))
#endif

static inline float8 trilinear_8(global const packed_t* texels, const Footprint* f, uint i) {
  const float8 fine = bilinear_8(texels + 8 * INDEX_LANE(f->fine.first, i), INDEX_LANE(f->fine.pitch, i),
                                 LANE(f->fine.x, i), LANE(f->fine.y, i));
  const float8 coarse =
      bilinear_8(texels + 8 * INDEX_LANE(f->coarse.first, i), INDEX_LANE(f->coarse.pitch, i),
                 LANE(f->coarse.x, i), LANE(f->coarse.y, i));
  return fma(coarse - fine, (float8)(LANE(f->mix, i)), fine);
}

static inline float4 trilinear_4(global const ushort* texels, const Footprint* f, uint i) {
  const float4 fine = bilinear_4(texels + 4 * INDEX_LANE(f->fine.first, i), INDEX_LANE(f->fine.pitch, i),
                                 LANE(f->fine.x, i), LANE(f->fine.y, i));
  const float4 coarse =
      bilinear_4(texels + 4 * INDEX_LANE(f->coarse.first, i), INDEX_LANE(f->coarse.pitch, i),
                 LANE(f->coarse.x, i), LANE(f->coarse.y, i));
  return fma(coarse - fine, (float4)(LANE(f->mix, i)), fine);
}

typedef struct Texels4 {
  real c[4];
} Texels4;

typedef struct Texels8 {
  real c[8];
} Texels8;

// Channels from 0 to 1.
static inline Texels4 filtered_4(global const ushort* texels, global const SurfaceMap* map,
                                 TexturePlace place) {
  const Footprint f = footprint_of(map, place);
  global const ushort* chain = texels + 4 * (size_t)map->base;
  Texels4 t;
#if LANES == 1
  const float4 p = trilinear_4(chain, &f, 0);
  t.c[0] = p.x, t.c[1] = p.y, t.c[2] = p.z, t.c[3] = p.w;
#else
  float16 four[4];  // pixels
#pragma unroll
  for (uint i = 0; i < 4; ++i) {
    four[i] = (float16)(trilinear_4(chain, &f, 4 * i), trilinear_4(chain, &f, 4 * i + 1),
                        trilinear_4(chain, &f, 4 * i + 2), trilinear_4(chain, &f, 4 * i + 3));
  }
  t.c[0] = (float16)(four[0].s048c, four[1].s048c, four[2].s048c, four[3].s048c);
  t.c[1] = (float16)(four[0].s159d, four[1].s159d, four[2].s159d, four[3].s159d);
  t.c[2] = (float16)(four[0].s26ae, four[1].s26ae, four[2].s26ae, four[3].s26ae);
  t.c[3] = (float16)(four[0].s37bf, four[1].s37bf, four[2].s37bf, four[3].s37bf);
#endif
  for (uint i = 0; i < 4; ++i) t.c[i] *= TEXEL_STEP;
  return t;
}

static inline Texels8 filtered_8(global const ushort* texels, global const SurfaceMap* map,
                                 TexturePlace place) {
  const Footprint f = footprint_of(map, place);
  global const packed_t* chain = (global const packed_t*)texels + 8 * (size_t)map->base;
  Texels8 t;
#if LANES == 1
  const float8 p = trilinear_8(chain, &f, 0);
  t.c[0] = p.s0, t.c[1] = p.s1, t.c[2] = p.s2, t.c[3] = p.s3, t.c[4] = p.s4, t.c[5] = p.s5, t.c[6] = p.s6,
  t.c[7] = p.s7;
#else
  float16 even[4], odd[4];  // channels 0, 2, 4, 6 and 1, 3, 5, 7 of four pixels
#pragma unroll
  for (uint i = 0; i < 4; ++i) {
    const float16 a = (float16)(trilinear_8(chain, &f, 4 * i), trilinear_8(chain, &f, 4 * i + 1));
    const float16 b = (float16)(trilinear_8(chain, &f, 4 * i + 2), trilinear_8(chain, &f, 4 * i + 3));
    even[i] = (float16)(a.even, b.even), odd[i] = (float16)(a.odd, b.odd);
  }
  t.c[0] = (float16)(even[0].s048c, even[1].s048c, even[2].s048c, even[3].s048c);
  t.c[2] = (float16)(even[0].s159d, even[1].s159d, even[2].s159d, even[3].s159d);
  t.c[4] = (float16)(even[0].s26ae, even[1].s26ae, even[2].s26ae, even[3].s26ae);
  t.c[6] = (float16)(even[0].s37bf, even[1].s37bf, even[2].s37bf, even[3].s37bf);
  t.c[1] = (float16)(odd[0].s048c, odd[1].s048c, odd[2].s048c, odd[3].s048c);
  t.c[3] = (float16)(odd[0].s159d, odd[1].s159d, odd[2].s159d, odd[3].s159d);
  t.c[5] = (float16)(odd[0].s26ae, odd[1].s26ae, odd[2].s26ae, odd[3].s26ae);
  t.c[7] = (float16)(odd[0].s37bf, odd[1].s37bf, odd[2].s37bf, odd[3].s37bf);
#endif
  for (uint i = 0; i < 8; ++i) t.c[i] *= PACKED_STEP;
  return t;
}

// --- Alphas
// ----------------------------------------------------------------------------------------------------------

static inline whole gathered(global const uint* from, whole at) {
#if LANES == 1
  return (int)from[at];
#else
  return as_int16((uint16)(from[at.s0], from[at.s1], from[at.s2], from[at.s3], from[at.s4], from[at.s5],
                           from[at.s6], from[at.s7], from[at.s8], from[at.s9], from[at.sa], from[at.sb],
                           from[at.sc], from[at.sd], from[at.se], from[at.sf]));
#endif
}

static inline real bilinear_alpha(global const uint* chain, LevelFootprint f) {
  const whole quad = gathered(chain, f.first);
  const real a = TO_REAL(quad & 255), b = TO_REAL(quad >> 8 & 255), c = TO_REAL(quad >> 16 & 255),
             d = TO_REAL(quad >> 24 & 255);
  const real low = fma(c - a, f.y, a), high = fma(d - b, f.y, b);
  return fma(high - low, f.x, low);
}

// From 0 to 1. The map's levels are those of its chain of alphas, which begins at `base`.
static inline real filtered_alpha(global const uint* alphas, uint base, global const SurfaceMap* map,
                                  TexturePlace place) {
  const Footprint f = footprint_of(map, place);
  const real fine = bilinear_alpha(alphas + base, f.fine), coarse = bilinear_alpha(alphas + base, f.coarse);
  return fma(coarse - fine, f.mix, fine) * (1.0f / 255.0f);
}
