// A square part of a shadow map's face, with its texels, which a work-item draws.
//
// -DSHADOW_BITS  of a texel (shadow_texels.h)
// -DLANES        16 texels of a row at once, or 1
#pragma once

#include "kernels/shadow_maps/shadow_texels.h"
#include "shared/real.h"
#include "shared/shadow_face.h"

// Texels a side. Where they are few, loops over them have constant bounds, which keeps them in registers.
#if LANES == 16
#define TILE FACE_TILE_LANES
#define LANE_INDICES LANE_INDEX
#define OVER_FEW
#define FIRST_OF(first) (first)
#define LAST_OF(last) (last)
#if SHADOW_BITS == 32
#define store_texels(v, p) vstore16(v, 0, p)
#elif SHADOW_BITS == 24
#define store_texels(v, p) vstore16(convert_uint16(v), 0, p)
#else
#define store_texels(v, p) vstore16(convert_ushort16(v), 0, p)
#endif
#else
#define TILE FACE_TILE_GROUP
#define LANE_INDICES 0
#define OVER_FEW _Pragma("unroll")
#define FIRST_OF(first) 0
#define LAST_OF(last) (TILE - 1)
#define store_texels(v, p) (*(p) = (Texel)(v))
#endif
#define PACKETS (TILE / LANES)  // a row

#define ROUNDING 1e-6f        // relative to coordinates: more than 8 roundings of 2^-24
#define TEXEL_ROUNDING 0.01f  // texels: more than what a triangle's bounds on the image round

typedef struct FaceTile {
  float3 from, right, up, ahead;
  float extent, range, scale;
  float step, first_u;   // u of column x: first_u + step x; v of rows likewise
  int size, x, y, side;  // the face's size; the tile's first texel, and its texels per side
  bool parallel;
  // Planes that bound what the tile sees: 4 sides, in front of the light, and -(distance ahead). The positive
  // and the negative parts of their normals; `offset` is of a directional light's sides.
  float8 rising_x, rising_y, rising_z, falling_x, falling_y, falling_z, offset;
  float farthest;  // no texel is more
  int drawn;       // triangles since `farthest` was found
  real texels[TILE * PACKETS];
} FaceTile;

// The builtins dot() and cross() may round otherwise on another device.
static inline float dot_in_order(float3 a, float3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline float3 at3(global const float* p) { return (float3)(p[0], p[1], p[2]); }

// The value that a texel stores for a distance; it is monotonic.
#if SHADOW_BITS == 32
#define texel_value(t, distance) (distance)
#define float_texel_value(t, distance) (distance)
#else
#define texel_value(t, distance) lane_floor((distance) * (t)->scale + 0.5f)
#define float_texel_value(t, distance) floor((distance) * (t)->scale + 0.5f)
#endif

// Side planes go through the centres of the outer texels, moved out by more than what triangles' bounds are:
// a triangle with a texel in its bounds is in no box that is left out.
static inline void set_planes(FaceTile* t) {
  const float low_u = t->first_u + t->step * ((float)t->x - 2 * TEXEL_ROUNDING),
              high_u = t->first_u + t->step * ((float)(t->x + t->side - 1) + 2 * TEXEL_ROUNDING),
              low_v = t->first_u + t->step * ((float)t->y - 2 * TEXEL_ROUNDING),
              high_v = t->first_u + t->step * ((float)(t->y + t->side - 1) + 2 * TEXEL_ROUNDING);
  const float8 along_right = (float8)(1, -1, 0, 0, 0, 0, 0, 0), along_up = (float8)(0, 0, 1, -1, 0, 0, 0, 0);
  const float8 sides = (float8)(-low_u, high_u, -low_v, high_v, 0, 0, 0, 0);
  const float8 along_ahead = (t->parallel ? (float8)(0) : sides) + (float8)(0, 0, 0, 0, 1, -1, 0, 0);
  t->offset = t->parallel ? sides : (float8)(0);
  const float8 zero = (float8)(0.0f);
#define SET_PLANES(axis)                                                                                \
  {                                                                                                     \
    const float8 n = along_right * t->right.axis + along_up * t->up.axis + along_ahead * t->ahead.axis; \
    t->rising_##axis = max(n, zero), t->falling_##axis = min(n, zero);                                  \
  }
  SET_PLANES(x)
  SET_PLANES(y)
  SET_PLANES(z)
}

static inline void set_tile(FaceTile* t, global const ShadowFace* f, uint number) {
  t->from = at3(f->from);
  t->right = at3(f->right);
  t->up = at3(f->up);
  t->ahead = at3(f->ahead);
  t->extent = f->extent;
  t->range = f->range_m;
  t->scale = texel_scale(f->range_m);
  t->size = (int)f->size;
  t->parallel = f->parallel != 0;
  t->step = 2 * t->extent / (float)t->size;
  t->first_u = (0.5f - 0.5f * (float)t->size) * t->step;
  t->side = min(TILE, t->size);
  // Neighbours first: squares of 16 texels, and tiles in these.
  const uint in_square = TILE < 16 ? 16 / TILE : 1, squares = (uint)t->size / (in_square * (uint)t->side);
  const uint square = number / (in_square * in_square), within = number % (in_square * in_square);
  t->x = (int)((square % squares * in_square + within % in_square) * (uint)t->side);
  t->y = (int)((square / squares * in_square + within / in_square) * (uint)t->side);
  t->farthest = TEXEL_NOTHING;
  t->drawn = 0;
  OVER_FEW for (int i = 0; i < TILE * PACKETS; ++i) t->texels[i] = REAL(TEXEL_NOTHING);
  set_planes(t);
}

// False: nothing in the box changes a texel, since it is out of range, beside the tile, or behind what is
// drawn. *nearest: no more than the distance ahead of what is in the box.
static inline bool may_change(const FaceTile* t, global const float* low, global const float* high,
                              float* nearest) {
  const float3 a = at3(low) - t->from, b = at3(high) - t->from;
  const float8 most =
      fma(t->rising_x, (float8)(b.x),
          fma(t->falling_x, (float8)(a.x),
              fma(t->rising_y, (float8)(b.y),
                  fma(t->falling_y, (float8)(a.y),
                      fma(t->rising_z, (float8)(b.z), fma(t->falling_z, (float8)(a.z), t->offset))))));
  const float3 reach = max(fabs(a), fabs(b)), off = max(max(a, -b), (float3)(0.0f));
  const float slack = ROUNDING * (1 + t->extent) * (reach.x + reach.y + reach.z);
  *nearest = -most.s5 - slack;
  if (min(min(most.s0, most.s1), min(min(most.s2, most.s3), most.s4)) < -slack) return false;
  if (!t->parallel && dot_in_order(off, off) > t->range * t->range * 1.00001f) return false;
  return !(*nearest > t->range) && float_texel_value(t, *nearest) < t->farthest;
}
