// Tests of lights against cells. A test may keep a light that touches none, and never drops one that does.
//
// Why they are conservative: each test computes, in float, a lower bound of a distance and compares it with
// the radius, which has grown by more than all rounding errors of the computation: docs/hard_cases.md#slack.
// Why a coarse step drops nothing that the fine step would keep: for a larger box each expression below is,
// operation by operation, no larger, and rounding preserves that order. The lists are therefore those of
// testing every light against every cell, whatever the hierarchy.
#pragma once

#include "kernels/culling/cell.h"

// Squared distance from the centre to the cell's box; NaN where the light's radius is invalid.
static inline real box_distance2(ViewSphere s, const Cell* c) {
  const real x = s.x - lane_min(lane_max(s.x, (real)(c->box_x0)), (real)(c->box_x1));
  const real y = s.y - lane_min(lane_max(s.y, (real)(c->box_y0)), (real)(c->box_y1));
  const real d = s.d - lane_min(lane_max(s.d, (real)(c->near)), (real)(c->far));
  return x * x + y * y + d * d;
}

#if CULL_TEST == CULL_SPHERE
// The sphere around the cell's box.
static inline mask_t sphere_may_touch(ViewSphere s, const Cell* c) {
  const real x = s.x - 0.5f * (c->box_x0 + c->box_x1), y = s.y - 0.5f * (c->box_y0 + c->box_y1);
  const real d = s.d - 0.5f * (c->near + c->far);
  const float hx = c->box_x1 - c->box_x0, hy = c->box_y1 - c->box_y0, hd = c->far - c->near;
  const real reach = s.r + 0.5f * sqrt(hx * hx + hy * hy + hd * hd) * (1.0f + SLACK);
  return (s.d + s.r >= c->near) & (s.d - s.r <= c->far) & (x * x + y * y + d * d <= reach * reach);
}
#endif

#if CULL_TEST == CULL_EXACT
// The squared distance f from the centre to the cell's cross-section at distance t; g, half its derivative in
// t; and bend, the derivative of g while the nearest side stays the same.
typedef struct Section {
  real f, g, bend;
} Section;

static inline Section section_at(ViewSphere s, const Cell* c, real t, uint orthographic) {
  const real scale = orthographic ? (real)(1.0f) : t;
  const real left = c->x0 * scale - s.x, right = s.x - c->x1 * scale;
  const real low = c->y0 * scale - s.y, high = s.y - c->y1 * scale;
  real slope_x = left > (real)(0.0f) ? (real)(c->x0) : (right > (real)(0.0f) ? (real)(-c->x1) : (real)(0.0f));
  real slope_y = low > (real)(0.0f) ? (real)(c->y0) : (high > (real)(0.0f) ? (real)(-c->y1) : (real)(0.0f));
  if (orthographic) slope_x = slope_y = 0.0f;
  const real x = lane_max(lane_max(left, right), (real)(0.0f)),
             y = lane_max(lane_max(low, high), (real)(0.0f));
  const real d = t - s.d;
  const Section at = {d * d + x * x + y * y, d + slope_x * x + slope_y * y,
                      1.0f + slope_x * slope_x + slope_y * slope_y};
  return at;
}

// Returns the lights in `keep` that may touch the cell itself. f is convex in t with f'' >= 2, so for every
// u in [near, far] f(u) >= f(t) + 2 g (u - t) + (u - t)^2: a lower bound whatever t is. t is a Newton
// iterate. f is quadratic in pieces, so one step is exact unless the nearest faces change. g is moved towards
// the minimum by its rounding error. A light is kept when a section touches it and dropped when the bound
// exceeds its radius; after four steps, or with NaN, it is kept.
static inline mask_t exact_may_touch(mask_t keep, ViewSphere s, const Cell* c, uint orthographic) {
  const real near = c->near, far = c->far, r2 = s.r * s.r;
  real t = lane_min(lane_max(s.d, near), far);
  Section at = section_at(s, c, t, orthographic);
  mask_t open = keep & (at.f > r2);
  for (int i = 0; i < 4 && any_lane(open); ++i) {
    t = lane_min(lane_max(t - at.g / at.bend, near), far);
    at = section_at(s, c, t, orthographic);
    const real error = SLACK * (fabs(s.x) + fabs(s.y) + fabs(s.d) + s.r) * at.bend;
    const real steepest = fabs(at.g) + error;
    const real step = lane_min(steepest, at.g > (real)(0.0f) ? t - near : far - t);
    const mask_t beyond = open & (at.f - (2.0f * steepest - step) * step - error * error > r2);
    keep &= beyond == (mask_t)(0);
    open &= (at.f > r2) & (beyond == (mask_t)(0));
  }
  return keep;
}
#endif

// The coarse steps' test, for lights whose tile rectangle meets the cell's.
static inline mask_t may_touch_coarsely(ViewSphere s, const Cell* c) {
#if CULL_TEST == CULL_SPHERE || CULL_TEST == CULL_PLANES
  return (s.d + s.r >= c->near) & (s.d - s.r <= c->far);
#else
  return (box_distance2(s, c) > s.r * s.r) == (mask_t)(0);
#endif
}

// The fine step's test, for lights whose tile rectangle holds the cell's tile. NaN keeps the light.
static inline mask_t may_touch(ViewSphere s, const Cell* c, constant CullParams* p) {
#if CULL_TEST == CULL_SPHERE
  return sphere_may_touch(s, c);
#elif CULL_TEST == CULL_EXACT
  return exact_may_touch((box_distance2(s, c) > s.r * s.r) == (mask_t)(0), s, c, p->orthographic);
#else
  return may_touch_coarsely(s, c);
#endif
}

#ifdef SPOTS
// Unit axis with d = -z, and the cosine of the outer half-angle; above 1.5 where there is no cone.
typedef struct ViewCone {
  real x, y, d, cosine;
} ViewCone;

// The cone against the sphere around the cell's box (Wronski, "Cull that cone!", 2017). Sound up to a
// half-angle of 90 degrees. Past that a cone is not convex and the test loses cells (12 % of them at 100
// degrees), so such a light has no cone here and only its sphere is tested. The distance from the axis comes
// from the cross product: |v|^2 - along^2 would cancel near the axis. The comparisons are written so that NaN
// keeps the light: far, wide cells overflow.
static inline mask_t cone_may_touch(ViewSphere s, ViewCone k, const Cell* c, constant CullParams* p) {
  const float cx = 0.5f * (c->box_x0 + c->box_x1), cy = 0.5f * (c->box_y0 + c->box_y1),
              cd = 0.5f * (c->near + c->far);
  const float hx = c->box_x1 - c->box_x0, hy = c->box_y1 - c->box_y0, hd = c->far - c->near;
  const float half_size = 0.5f * sqrt(hx * hx + hy * hy + hd * hd) * (1.0f + SLACK);
  // The rounding of the apex on upload and of the tile's sides come on top of the coordinates' own rounding.
  const float sides = p->side_slack * (fabs(c->near) + fabs(c->far)) + (p->side_slack_m + LEAST_RADIUS);
  const float size = half_size + (sides + p->cone_slack_m);
  const float centre = fabs(cx) + fabs(cy) + fabs(cd);
  const real x = cx - s.x, y = cy - s.y, d = cd - s.d;
  const real reach =
      size + 2.0f * SLACK * (fabs(x) + fabs(y) + fabs(d) + fabs(s.x) + fabs(s.y) + fabs(s.d) + centre);
  const real along = x * k.x + y * k.y + d * k.d;
  const real sine = sqrt(lane_max((real)(1.0f) - k.cosine * k.cosine, (real)(0.0f)));
  const real ax = y * k.d - d * k.y, ay = d * k.x - x * k.d, ad = x * k.y - y * k.x;
  const real across = sqrt(ax * ax + ay * ay + ad * ad);
  const mask_t outside = (across * k.cosine - along * sine > reach) | (along < -reach);
  return (k.cosine > (real)(1.5f)) | (outside == (mask_t)(0));
}
#endif
