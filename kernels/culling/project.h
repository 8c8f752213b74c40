// A light in view space, and the tiles its sphere can be seen in.
#pragma once

#include "kernels/common/pack.h"
#include "shared/cull_constants.h"
#include "shared/cull_params.h"
#include "shared/cull_tests.h"

#ifndef CULL_TEST
#define CULL_TEST CULL_PLANES_AABB
#endif

// Radii grow by this part of |x| + |y| + |d| + radius before any test. That covers every rounding from
// the light's world position to the comparison, except the rounding of tile sides, which the view
// gives: docs/hard_cases.md#slack.
#define SLACK (24.0f * 5.9604645e-8f)
// Radii also grow by this, metres: squares of smaller numbers underflow.
#define LEAST_RADIUS 1e-18f
// Tangents and tile coordinates round to this part of themselves: docs/details/hard_cases.md#tangents.
#define TANGENT_SLACK (32.0f * 5.9604645e-8f)

// View space with d = -z, metres; r is the radius with slack.
typedef struct ViewSphere {
  real x, y, d, r;
} ViewSphere;

static inline ViewSphere view_sphere(real world_x, real world_y, real world_z, real radius,
                                     constant CullParams* p) {
  const real x = (world_x - p->eye_x) - p->eye_rest_x;
  const real y = (world_y - p->eye_y) - p->eye_rest_y;
  const real z = (world_z - p->eye_z) - p->eye_rest_z;
  ViewSphere s;
  s.x = p->x_axis_x * x + p->x_axis_y * y + p->x_axis_z * z;
  s.y = p->y_axis_x * x + p->y_axis_y * y + p->y_axis_z * z;
  s.d = p->d_axis_x * x + p->d_axis_y * y + p->d_axis_z * z;
  const real distance = fabs(s.d) + radius;
  const float distance_slack = SLACK + p->side_slack, constant_slack = p->side_slack_m + LEAST_RADIUS;
  s.r = radius + (SLACK * (fabs(s.x) + fabs(s.y)) + distance_slack * distance + constant_slack);
  return s;
}

// Slopes v / d of the two tangents from the eye to the circle of radius r around (v, d), d > -r. No form
// below cancels: sums have terms of one sign, and differences are taken of input numbers only. Where the
// circle reaches past the eye (d <= r) it has no bound on its own side; where the eye is inside, it has no
// bound on either side. Near the circle's edge, from outside, the root does cancel. It is then reduced by its
// error bound, which moves the tangent outwards.
static inline void tangent_slopes(real v, real d, real r, real* low, real* high) {
  const real n = (v - r) * (v + r), e = (d - r) * (d + r);
  const mask_t open = d <= r;
  const real lost = open ? TANGENT_SLACK * (v * v + d * d + r * r) : (real)(0.0f);
  const real root2 = n > (real)(0.0f) ? n + d * d : v * v + e - lost;
  const mask_t outside = root2 > (real)(0.0f);
  const real q = r * sqrt(root2);
  const real s = v * d, a = s + q, b = s - q;
  const mask_t same = s >= (real)(0.0f);
  const real from = (same ? n : b) / (same ? a : e), to = (same ? a : n) / (same ? e : b);
  *low = (open & ((v < (real)(0.0f)) | (outside == (mask_t)(0)))) ? (real)(-FAR_AWAY) : from;
  *high = (open & ((v >= (real)(0.0f)) | (outside == (mask_t)(0)))) ? (real)(FAR_AWAY) : to;
}

// First and last tile whose pixels a slope from `low` to `high` can reach. `pixels` pixels are
// divided into tiles of `size`; a cell is smaller than its tile by `inset` pixels on each side. No
// tile: first > last. NaN keeps every tile.
static inline void tile_range(real low, real high, float scale, float offset, float inset, uint pixels,
                              float size, whole* first, whole* last) {
  const float margin = inset / size, end = ((float)pixels - inset) / size;
  const int last_tile = (int)((pixels - 1) / (uint)size);
  const real from = low * scale, to = high * scale;
  const real from_slack = TANGENT_SLACK * (fabs(from) + fabs(offset) + 1.0f);
  const real to_slack = TANGENT_SLACK * (fabs(to) + fabs(offset) + 1.0f);
  const real begin = (from + offset) - from_slack;
  const real f = lane_floor(lane_min(lane_max(begin + margin, (real)(-1.0f)), (real)(32000.0f)));
  const real t =
      lane_floor(lane_max(lane_min((to + offset) - (margin - to_slack), (real)(32000.0f)), (real)(-1.0f)));
  *first = begin > (real)(end) ? (whole)(32000) : max(TO_WHOLE(f), (whole)(0));  // the last tile is cut
  *last = min(TO_WHOLE(t), (whole)(last_tile));
}

// A rectangle of tiles in two words: columns in the low half, rows in the high half.
// An empty one meets no rectangle.
typedef struct TileRect {
  whole first, last;
} TileRect;

// radius: without slack; below 0: no light.
static inline TileRect tile_rect(ViewSphere s, real radius, constant CullParams* p) {
  whole x0 = 0, x1 = (int)p->tiles_x - 1, y0 = 0, y1 = (int)p->tiles_y - 1;
  mask_t gone = !(radius >= (real)(0.0f));
#if CULL_TEST != CULL_AABB && CULL_TEST != CULL_SPHERE
  real low_x = s.x - s.r, high_x = s.x + s.r, low_y = s.y - s.r, high_y = s.y + s.r;
  if (!p->orthographic) {
    tangent_slopes(s.x, s.d, s.r, &low_x, &high_x);
    tangent_slopes(s.y, s.d, s.r, &low_y, &high_y);
    gone |= s.d < -s.r;
  }
  const float size = (float)p->tile_size;
  tile_range(low_x, high_x, p->tile_x_scale, p->tile_x_offset, p->inset, p->width, size, &x0, &x1);
  tile_range(low_y, high_y, p->tile_y_scale, p->tile_y_offset, p->inset, p->height, size, &y0, &y1);
  gone |= (x0 > x1) | (y0 > y1);
#endif
  TileRect rect;
  rect.first = gone ? (whole)(0x7fff7fff) : x0 | y0 << 16;
  rect.last = gone ? (whole)(0) : x1 | y1 << 16;
  return rect;
}

// Returns whether r shares a tile with columns x0 ... x1 and rows y0 ... y1, given as first = x0 | y0 << 16,
// last likewise. Both halves are compared at once: a half below 0 sets its top bit. Halves hold 15 bits.
static inline mask_t rect_meets(TileRect r, int first, int last) {
  return ((r.last - first | last - r.first) & (whole)(0x80008000)) == (whole)(0);
}
