// Corners in clip space to a record (shared/raster_params.h): snapping, facing, depth plane, box. LANES
// triangles at once. Every step is one correctly rounded operation or exact, so that all devices make the
// same record: docs/raster.md.
#pragma once

#include "kernels/common/sample_places.h"
#include "shared/lanes.h"
#include "shared/raster_instance.h"
#include "shared/raster_params.h"

typedef struct Corners {
  real x, y, z, w;
} Corners;

// As RasterRecord, a value a lane.
typedef struct RecordLanes {
  whole x[3], y[3];
  real z0, zx, zy, z_min, z_max;
  whole triangle, box_low, box_high, instance, alpha_material;
} RecordLanes;

// a b - c d, within 2^-23 of itself, and 0 only where it is 0 (Jeannerod, Louvet, Muller, "Further Analysis
// of Kahan's Algorithm for the Accurate Computation of 2 x 2 Determinants", 2013).
static inline real difference_of_products(real a, real b, real c, real d) {
  const real product = c * d, rest = fma(-c, d, product);
  return fma(a, b, -product) + rest;
}

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
static inline real least_of(const real* v) { return lane_min(v[0], lane_min(v[1], v[2])); }
static inline real most_of(const real* v) { return lane_max(v[0], lane_max(v[1], v[2])); }

// Deeper corners count as this deep, so that gradients stay finite. In real numbers no pixel changes: a
// corner has 2^-47 or more of a sample's weight, or none, so a sample off the edge between the other two is
// behind the far plane anyway.
#define DEEPEST (-1.8446744073709552e19f)  // -2^64

// Triangles whose corners need no cut, where `live`. Fills all of the record but its numbers, and returns
// which triangles face the eye and may cover a pixel's sample.
static inline mask_t set_up(const Corners* v, mask_t live, uint flags, RecordLanes* out,
                            constant RasterParams* p) {
  const real half_x = p->half_x, half_y = p->half_y, zero = 0.0f, one = 1.0f, deepest = DEEPEST;
  real z[3];
  whole x[3], y[3];
  for (int k = 0; k < 3; ++k) {
    const real per_w = one / v[k].w, sx = fma(v[k].x * per_w, half_x, half_x),
               sy = fma(v[k].y * per_w, half_y, half_y);
    x[k] = TO_WHOLE(lane_rint(live ? sx : zero)), y[k] = TO_WHOLE(lane_rint(live ? sy : zero));
    z[k] = lane_max(lane_min(v[k].z * per_w, one), deepest);
  }
  // Pixels of which the sample that lies farthest to a side may be covered.
  const int right = most_gain(1, 0), left = most_gain(-1, 0), up = most_gain(0, 1), down = most_gain(0, -1);
  const whole low_x = whole_max((whole_min(x[0], whole_min(x[1], x[2])) + (127 - right)) >> 8, (whole)(0));
  const whole low_y = whole_max((whole_min(y[0], whole_min(y[1], y[2])) + (127 - up)) >> 8, (whole)(0));
  const whole high_x =
      whole_min((whole_max(x[0], whole_max(x[1], x[2])) + (left - 128)) >> 8, (whole)((int)p->width - 1));
  const whole high_y =
      whole_min((whole_max(y[0], whole_max(y[1], y[2])) + (down - 128)) >> 8, (whole)((int)p->height - 1));

  // Below 2^24, so exact as floats.
  const real ax = TO_REAL(x[1] - x[0]), ay = TO_REAL(y[1] - y[0]), bx = TO_REAL(x[2] - x[0]),
             by = TO_REAL(y[2] - y[0]);
  const real area = difference_of_products(ax, by, bx, ay);  // twice the triangle's; its sign is exact
  const mask_t clockwise = area < zero;
  mask_t faces = area != zero;
  if (!(flags & RASTER_TWO_SIDED)) faces = flags & RASTER_MIRRORED ? clockwise : area > zero;

  out->x[0] = x[0], out->x[1] = clockwise ? x[2] : x[1], out->x[2] = clockwise ? x[1] : x[2];
  out->y[0] = y[0], out->y[1] = clockwise ? y[2] : y[1], out->y[2] = clockwise ? y[1] : y[2];
  // Depths from corner 0's; the signs of numerators and area cancel where corners 1 and 2 change places.
  const real za = z[1] - z[0], zb = z[2] - z[0], per_area = (real)(256.0f) / area;
  out->z0 = z[0];
  out->zx = difference_of_products(za, by, zb, ay) * per_area;
  out->zy = difference_of_products(zb, ax, za, bx) * per_area;
  out->z_min = least_of(z), out->z_max = most_of(z);
  out->box_low = low_x | low_y << 16, out->box_high = high_x | high_y << 16;
  return live & faces & (low_x <= high_x) & (low_y <= high_y);
}
