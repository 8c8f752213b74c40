// May this light's sphere or cone touch this cell? A light may be kept in vain, never dropped in error.
//
// Why conservative: each test computes, in float, a lower bound of a distance and compares it with the radius. The
// rounding error of those computations is below SLACK * (|X| + |Y| + |D| + r), because side planes are in slope form
// (1, 0, -slope), with no cross products to cancel; the radius is inflated by that much before any test.
// The bound and its derivation: docs/hard_cases.md#slack.
#pragma once

#include "kernels/common/cell.h"
#include "kernels/common/lanes.h"

#define SLACK (4.0f * 1.1920929e-7f)  // 4 units in the last place of 1

#define CULL_SPHERE 0       // the cell's bounding sphere
#define CULL_PLANES 1       // four side planes and the distance interval
#define CULL_AABB 2         // the cell's view-space box (Arvo 1990)
#define CULL_PLANES_AABB 3  // both
#ifndef CULL_TEST
#define CULL_TEST CULL_PLANES_AABB
#endif

static inline real inflated(real x, real y, real d, real radius) {
  return radius + SLACK * (fabs(x) + fabs(y) + fabs(d) + radius);
}

// x, y, d: centre in view space (d = -z); r: inflated radius, >= 0, may be infinite.
static inline mask_t sphere_may_touch(real x, real y, real d, real r, const Cell* c) {
  mask_t keep = (d + r >= c->near) & (d - r <= c->far);
#if CULL_TEST == CULL_PLANES || CULL_TEST == CULL_PLANES_AABB
  real dx = c->orthographic ? (real)(1.0f) : d, dy = dx;
  keep &= (x - c->x0 * dx >= -r * c->norm_x0) & (c->x1 * dx - x >= -r * c->norm_x1);
  keep &= (y - c->y0 * dy >= -r * c->norm_y0) & (c->y1 * dy - y >= -r * c->norm_y1);
#endif
#if CULL_TEST == CULL_AABB || CULL_TEST == CULL_PLANES_AABB
  real bx = lane_max(lane_max(c->box_x0 - x, x - c->box_x1), (real)(0.0f));
  real by = lane_max(lane_max(c->box_y0 - y, y - c->box_y1), (real)(0.0f));
  real bz = lane_max(lane_max(c->near - d, d - c->far), (real)(0.0f));
  keep &= bx * bx + by * by + bz * bz <= r * r;
#endif
#if CULL_TEST == CULL_SPHERE
  real sx = x - 0.5f * (c->box_x0 + c->box_x1), sy = y - 0.5f * (c->box_y0 + c->box_y1);
  real sz = d - 0.5f * (c->near + c->far);
  float hx = c->box_x1 - c->box_x0, hy = c->box_y1 - c->box_y0, hz = c->far - c->near;
  real reach = r + 0.5f * sqrt(hx * hx + hy * hy + hz * hz) * (1.0f + 2.0f * SLACK);
  keep &= sx * sx + sy * sy + sz * sz <= reach * reach;
#endif
  return keep;
}

#ifdef SPOTS
// The cone of a spot against the sphere around the cell's box. Sound up to a half-angle of 90 degrees; past that a
// cone is not convex and the test loses cells (12 % of them at 100 degrees), so such a light has no cone here and
// its sphere decides. Unit axis with its third component along d = -z; w: cosine of the outer half-angle, >= 0.
static inline bool cone_may_touch(float x, float y, float d, float4 cone, const Cell* c) {
  if (cone.w > 1.5f) return true;  // no cone
  const float cx = 0.5f * (c->box_x0 + c->box_x1), cy = 0.5f * (c->box_y0 + c->box_y1), cd = 0.5f * (c->near + c->far);
  const float hx = c->box_x1 - c->box_x0, hy = c->box_y1 - c->box_y0, hz = c->far - c->near;
  const float vx = cx - x, vy = cy - y, vd = cd - d;
  const float scale = fabs(vx) + fabs(vy) + fabs(vd) + fabs(x) + fabs(y) + fabs(d) + fabs(cx) + fabs(cy) + fabs(cd);
  const float reach = 0.5f * sqrt(hx * hx + hy * hy + hz * hz) * (1.0f + 2.0f * SLACK) + 4.0f * SLACK * scale;
  const float sine = sqrt(max(0.0f, 1.0f - cone.w * cone.w));
  const float along = vx * cone.x + vy * cone.y + vd * cone.z;
  // Distance from the axis through the cross product: |v|^2 - along^2 would cancel near the axis.
  const float px = vy * cone.z - vd * cone.y, py = vd * cone.x - vx * cone.z, pd = vx * cone.y - vy * cone.x;
  const float across = sqrt(px * px + py * py + pd * pd);
  // Asked so that NaN keeps the light: far, wide cells overflow, and inf * 0 or inf - inf tells nothing.
  return !(across * cone.w - along * sine > reach) && !(along < -reach);
}
#endif
