// Attributes of a triangle at pixels, and their derivatives: perspective-correct, for any position of the
// triangle, corners behind the eye included. 2D homogeneous coordinates (Olano, Greer, "Triangle Scan
// Conversion using 2D Homogeneous Coordinates", HWWS 1997): with corners (x, y, w) on the screen, the edge
// functions at a pixel are cross products of two corners each, linear in the pixel, and an attribute is their
// mean with these weights.
//
// Coordinates are relative to the first pixel of the pixel's block of 4 x 4, so that LANES does not change a
// bit.
#pragma once

#include "kernels/common/texture_footprint.h"

// A triangle seen from a block: edge function i at (dx, dy) from the block's first pixel centre is
// right[i] * dx + up[i] * dy + here[i], and member 3 is the sum of the three.
typedef struct ScreenTriangle {
  float4 right, up, here;
} ScreenTriangle;

// Clip-space corners. (x, y): the block's first pixel; half_size: of the image, pixels.
static inline ScreenTriangle screen_triangle(float4 a, float4 b, float4 c, float x, float y,
                                             float2 half_size) {
  const float to_x = half_size.x - (x + 0.5f), to_y = half_size.y - (y + 0.5f);
  const float4 w = (float4)(a.w, b.w, c.w, 0.0f);
  const float4 px = fma((float4)(a.x, b.x, c.x, 0.0f), (float4)(half_size.x), w * to_x);
  const float4 py = fma((float4)(a.y, b.y, c.y, 0.0f), (float4)(half_size.y), w * to_y);
  ScreenTriangle t;
  t.right = fma(py.yzxw, w.zxyw, -(w.yzxw * py.zxyw));
  t.up = fma(w.yzxw, px.zxyw, -(px.yzxw * w.zxyw));
  t.here = fma(px.yzxw, py.zxyw, -(py.yzxw * px.zxyw));
  t.right.w = t.right.x + t.right.y + t.right.z;
  t.up.w = t.up.x + t.up.y + t.up.z;
  t.here.w = t.here.x + t.here.y + t.here.z;
  return t;
}

// Coverage is that of corners snapped to 1/256 pixel, so that a covered centre may lie outside of the
// triangle itself. Of a triangle less than a few hundredths of a pixel wide it may lie far outside, where
// attributes mean nothing, or where the weights are 0 / 0. No weight is allowed to be further from 0 to 1
// than this.
#define MOST_OUTSIDE 0.25f

// Weights of the first two corners at LANES pixels; what is left of 1 is the third's. `sum` is positive where
// the corners turn counter-clockwise.
typedef struct Weights {
  real first, second, sum, inverse_sum;
} Weights;

static inline Weights weights_at(const ScreenTriangle* t, real dx, real dy) {
  Weights w;
  w.sum = fma(dx, REAL(t->right.w), fma(dy, REAL(t->up.w), REAL(t->here.w)));
  w.inverse_sum = 1.0f / w.sum;
  const real first = fma(dx, REAL(t->right.x), fma(dy, REAL(t->up.x), REAL(t->here.x))) * w.inverse_sum;
  const real second = fma(dx, REAL(t->right.y), fma(dy, REAL(t->up.y), REAL(t->here.y))) * w.inverse_sum;
  const real least = -MOST_OUTSIDE, most = 1.0f + MOST_OUTSIDE;
  w.first = lane_min(lane_max(first, least), most);
  w.second = lane_min(lane_max(second, least), most - w.first);
  return w;
}

// SurfaceVertex as numbers: the first two corners less the third, and the third.
typedef struct CornerAttributes {
  float16 first, second, third;
} CornerAttributes;

static inline CornerAttributes corner_attributes(global const SurfaceVertex* vertices, uint a, uint b,
                                                 uint c) {
#if LANES == 16
#define CORNER(i) vload16(i, (global const float*)vertices)
#else
#define CORNER(i) ((global const float16*)vertices)[i]  // aligned, which vload does not know
#endif
  const float16 third = CORNER(c);
  const CornerAttributes k = {CORNER(a) - third, CORNER(b) - third, third};
  return k;
}

#define ATTRIBUTE(corners, weights, member)           \
  (fma((weights).first, REAL((corners).first.member), \
       fma((weights).second, REAL((corners).second.member), REAL((corners).third.member))))

// The same of texture coordinates `u` and `v`, with their derivatives: of N / S with N and S linear, (N' - (N
// / S) S') / S.
#define TEXTURE_PLACE(corners, weights, triangle, u, v)                             \
  texture_place((float3)((corners).first.u, (corners).second.u, (corners).third.u), \
                (float3)((corners).first.v, (corners).second.v, (corners).third.v), weights, triangle)

static inline TexturePlace texture_place(float3 u, float3 v, Weights w, const ScreenTriangle* t) {
  const float u_right = t->right.x * u.x + t->right.y * u.y, u_up = t->up.x * u.x + t->up.y * u.y;
  const float v_right = t->right.x * v.x + t->right.y * v.y, v_up = t->up.x * v.x + t->up.y * v.y;
  const real from_third_u = fma(w.first, REAL(u.x), w.second * u.y),
             from_third_v = fma(w.first, REAL(v.x), w.second * v.y);
  TexturePlace p;
  p.u = from_third_u + u.z;
  p.v = from_third_v + v.z;
  p.u_right = fma(-from_third_u, REAL(t->right.w), REAL(u_right)) * w.inverse_sum;
  p.v_right = fma(-from_third_v, REAL(t->right.w), REAL(v_right)) * w.inverse_sum;
  p.u_up = fma(-from_third_u, REAL(t->up.w), REAL(u_up)) * w.inverse_sum;
  p.v_up = fma(-from_third_v, REAL(t->up.w), REAL(v_up)) * w.inverse_sum;
  return p;
}

// The pixels of a block, from its first one.
#if LANES == 16
#define BLOCK_DX ((float16)(0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3))
#define BLOCK_DY ((float16)(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3))
#endif
