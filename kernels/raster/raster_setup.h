// Corners in clip space to a record (shared/raster_params.h): snapping, facing, depth plane, box. LANES
// triangles at once. Every step is one correctly rounded operation or exact, so that all devices make the
// same record: docs/raster.md.
#pragma once

#include "kernels/common/sample_places.h"
#include "kernels/raster/depth_plane.h"
#include "shared/lanes.h"
#include "shared/raster_instance.h"
#include "shared/raster_params.h"

// As RasterRecord, a value a lane.
typedef struct RecordLanes {
  whole x[3], y[3];
  real z0, zx, zy, z_min, z_max;
  whole triangle, box_low, box_high, instance, alpha_material;
} RecordLanes;

// Half-spaces that a triangle is cut to, in this order: 0 or more is inside.
#define CUT_PLANES 5
static inline real inside_plane(int plane, Corners v, constant RasterParams* p) {
  const real guard_x = p->guard_x, guard_y = p->guard_y;
  switch (plane) {
    case 0:
      return v.w - v.z;
    case 1:
      return fma(guard_x, v.w, -v.x);
    case 2:
      return fma(guard_x, v.w, v.x);
    case 3:
      return fma(guard_y, v.w, -v.y);
    default:
      return fma(guard_y, v.w, v.y);
  }
}

// Needs no cut and is finite. False for NaN.
static inline mask_t is_inside(Corners v, constant RasterParams* p) {
  mask_t inside = (v.w >= (real)(FLT_MIN)) & (v.w <= (real)(FLT_MAX)) & (v.z >= (real)(-FLT_MAX));
  for (int plane = 0; plane < CUT_PLANES; ++plane) inside &= inside_plane(plane, v, p) >= (real)(0.0f);
  return inside;
}

// All three lie beyond one side of the view, or none has a depth that is drawn.
static inline mask_t out_of_view(const Corners* v) {
  const real zero = 0.0f;
  return ((v[0].z > v[0].w) & (v[1].z > v[1].w) & (v[2].z > v[2].w)) |
         ((v[0].z <= zero) & (v[1].z <= zero) & (v[2].z <= zero)) |
         ((v[0].x > v[0].w) & (v[1].x > v[1].w) & (v[2].x > v[2].w)) |
         ((-v[0].x > v[0].w) & (-v[1].x > v[1].w) & (-v[2].x > v[2].w)) |
         ((v[0].y > v[0].w) & (v[1].y > v[1].w) & (v[2].y > v[2].w)) |
         ((-v[0].y > v[0].w) & (-v[1].y > v[1].w) & (-v[2].y > v[2].w));
}

static inline whole whole_min(whole a, whole b) { return a < b ? a : b; }
static inline whole whole_max(whole a, whole b) { return a > b ? a : b; }
static inline real min_of(const real* v) { return lane_min(v[0], lane_min(v[1], v[2])); }
static inline real max_of(const real* v) { return lane_max(v[0], lane_max(v[1], v[2])); }

// Where a triangle's corners, or those of a part of it, are snapped to; the pixels that it may cover.
typedef struct SnappedLanes {
  whole x[3], y[3];
  whole low_x, low_y, high_x, high_y;
  real ax, ay, bx, by;  // from corner 0 to the others
  real area;            // twice the triangle's; its sign is exact
} SnappedLanes;

static inline SnappedLanes snapped_corners(const Corners* v, mask_t live, constant RasterParams* p) {
  const real half_x = p->half_x, half_y = p->half_y, zero = 0.0f, one = 1.0f;
  SnappedLanes s;
  for (int k = 0; k < 3; ++k) {
    const real per_w = one / v[k].w, sx = fma(v[k].x * per_w, half_x, half_x),
               sy = fma(v[k].y * per_w, half_y, half_y);
    s.x[k] = TO_WHOLE(lane_rint(live ? sx : zero));
    s.y[k] = TO_WHOLE(lane_rint(live ? sy : zero));
  }
  // Pixels of which the sample that lies farthest to a side may be covered.
  const int right = max_gain(1, 0), left = max_gain(-1, 0), up = max_gain(0, 1), down = max_gain(0, -1);
  s.low_x = whole_max((whole_min(s.x[0], whole_min(s.x[1], s.x[2])) + (127 - right)) >> 8, (whole)(0));
  s.low_y = whole_max((whole_min(s.y[0], whole_min(s.y[1], s.y[2])) + (127 - up)) >> 8, (whole)(0));
  s.high_x = whole_min((whole_max(s.x[0], whole_max(s.x[1], s.x[2])) + (left - 128)) >> 8,
                       (whole)((int)p->width - 1));
  s.high_y = whole_min((whole_max(s.y[0], whole_max(s.y[1], s.y[2])) + (down - 128)) >> 8,
                       (whole)((int)p->height - 1));
  // Below 2^24, so exact as floats.
  s.ax = TO_REAL(s.x[1] - s.x[0]);
  s.ay = TO_REAL(s.y[1] - s.y[0]);
  s.bx = TO_REAL(s.x[2] - s.x[0]);
  s.by = TO_REAL(s.y[2] - s.y[0]);
  s.area = difference_of_products(s.ax, s.by, s.bx, s.ay);
  return s;
}

// Into the record the depths of the triangle `of`, of which corners v, snapped to s, may be a part.
static inline void set_depths(const Corners* v, const Corners* of, const SnappedLanes* s, RecordLanes* out,
                              constant RasterParams* p) {
  real z[3], depths[3];
  for (int k = 0; k < 3; ++k) {
    z[k] = depth_of_corner(v[k]);
    depths[k] = depth_of_corner(of[k]);
  }
  out->z_min = min_of(depths);
  out->z_max = max_of(depths);
  real zx, zy;
  plane_gradients(of, &zx, &zy, p);
  // Else the triangle is thinner along its gradient than snapping moves corners, and most of what it covers
  // lies outside of it, where its plane is too steep. The plane through the snapped corners holds there.
  const mask_t thick = fabs(zx) + fabs(zy) <= 512.0f * (out->z_max - out->z_min);
  const real za = z[1] - z[0], zb = z[2] - z[0], per_area = (real)(256.0f) / s->area;
  zx = thick ? zx : difference_of_products(za, s->by, zb, s->ay) * per_area;
  zy = thick ? zy : difference_of_products(zb, s->ax, za, s->bx) * per_area;
  const whole x = (zx > (real)(0.0f) ? s->low_x : s->high_x) * 256 + 128,
              y = (zy > (real)(0.0f) ? s->low_y : s->high_y) * 256 + 128;  // anchor_pixel()
  const real from_snapped =
      fma(zx, TO_REAL(x - s->x[0]) * (1.0f / 256), fma(zy, TO_REAL(y - s->y[0]) * (1.0f / 256), z[0]));
  out->z0 = thick ? plane_depth_at(of, depths, zx, zy, x, y, p) : from_snapped;
  out->zx = zx;
  out->zy = zy;
}

// Triangles whose corners need no cut, or parts of triangles `of` that cutting left, where `live`. Fills all
// of the record but its numbers, and returns which triangles face the eye and may cover a pixel's sample.
static inline mask_t set_up(const Corners* v, const Corners* of, mask_t live, uint flags, RecordLanes* out,
                            constant RasterParams* p) {
  const SnappedLanes s = snapped_corners(v, live, p);
  const mask_t clockwise = s.area < (real)(0.0f);
  mask_t faces = s.area != (real)(0.0f);
  if (!(flags & RASTER_TWO_SIDED)) faces = flags & RASTER_MIRRORED ? clockwise : s.area > (real)(0.0f);
  out->x[0] = s.x[0];
  out->x[1] = clockwise ? s.x[2] : s.x[1];
  out->x[2] = clockwise ? s.x[1] : s.x[2];
  out->y[0] = s.y[0];
  out->y[1] = clockwise ? s.y[2] : s.y[1];
  out->y[2] = clockwise ? s.y[1] : s.y[2];
  set_depths(v, of, &s, out, p);
  out->box_low = s.low_x | s.low_y << 16;
  out->box_high = s.high_x | s.high_y << 16;
  return live & faces & (s.low_x <= s.high_x) & (s.low_y <= s.high_y);
}
