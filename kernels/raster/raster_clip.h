// A triangle cut to the near plane and the guard band (Sutherland, Hodgman, "Reentrant Polygon Clipping",
// CACM 1974). A point where an edge is cut is computed from the edge's end inside towards its end outside, so
// that both triangles of the edge get the same.
#pragma once

#include "shared/raster_params.h"

#define MOST_CORNERS \
  20  // 8 in real numbers; rounding can fold a sliver's outline, which then meets a plane more than twice

static inline float corner_inside(int plane, float4 v, constant RasterParams* p) {
  const float side = plane == 1 || plane == 3 ? -1.0f : 1.0f;
  if (plane == 0) return v.w - v.z;
  return plane <= 2 ? fma(p->guard_x, v.w, side * v.x) : fma(p->guard_y, v.w, side * v.y);
}

static inline float4 cut_point(float4 inside, float d_inside, float4 outside, float d_outside) {
  const float t = d_inside / (d_inside - d_outside);
  return fma((float4)(t), outside - inside, inside);
}

// Cuts the polygon in place, 3 corners at first. Returns how many it has then, or -1 where one is not finite,
// or lies at w = 0, where no projection puts it.
static inline int cut_triangle(float4* corners, constant RasterParams* p) {
  int count = 3;
  for (int k = 0; k < 3; ++k) {
    if (!all(isfinite(corners[k]))) return -1;
  }
  for (int plane = 0; plane < 5; ++plane) {
    float4 kept[MOST_CORNERS];
    int n = 0;
    for (int k = 0; k < count; ++k) {
      const float4 here = corners[k], next = corners[k + 1 == count ? 0 : k + 1];
      const float d_here = corner_inside(plane, here, p), d_next = corner_inside(plane, next, p);
      const bool in = d_here >= 0.0f, next_in = d_next >= 0.0f;
      if (in) kept[n++] = here;
      if (in != next_in)
        kept[n++] = in ? cut_point(here, d_here, next, d_next) : cut_point(next, d_next, here, d_here);
    }
    count = n;
    for (int k = 0; k < count; ++k) corners[k] = kept[k];
  }
  for (int k = 0; k < count; ++k) {
    if (!all(isfinite(corners[k])) || !(corners[k].w >= FLT_MIN)) return -1;
  }
  return count;
}
