// Where a texture filter reads, for LANES pixels that share a material: levels and texels of mip chains as
// renderer/upload/texel_chain.h lays them out, with OpenGL's wrap modes, magnification and minification filters
// (OpenGL 4.6, 8.14). The level of detail comes from exact derivatives, not from differences between pixels.
// Arithmetic is IEEE's alone, and so the same on every device.
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

// To 3.1e-4 for normal numbers; exact for powers of two.
static inline real rough_log2(real x) {
  const whole bits = bits_of_real(x);
  const real exponent = TO_REAL((bits >> 23) - 127), t = real_of_bits((bits & 0x7fffff) | 0x3f800000) - 1.0f;
  const real bend = fma(fma(REAL(0.08161574f), t, REAL(-0.24266946f)), t, REAL(0.44078080f));
  return exponent + fma(t * (1.0f - t), bend, t);
}

// Past it, floats are further apart than texels are; the shaders have the same limit.
#define MOST_UV 1e9f

// A coordinate folded into one copy of the texture: 0 to 1. Clamped ones are left to texel_of.
static inline real folded(real any, uint clamped, uint mirrored) {
  const real x = fabs(any) < REAL(MOST_UV) ? any : REAL(0.0f);
  if (clamped) return x;
  if (!mirrored) return x - lane_floor(x);
  return 1.0f - fabs(fma(REAL(-2.0f), lane_floor(x * 0.5f), x) - 1.0f);
}

// The first of the two texels along an axis, and the place between them.
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
