// The plane that a triangle's depths lie in on the screen, from its corners in clip space: not from where
// they are snapped to, and without cutting what lies behind the eye. N with N . (x, y, w) = z at each
// corner is found; N . (x, y, 1) is then the depth at (x, y) in normalized device coordinates (Olano, Greer,
// "Triangle Scan Conversion using 2D Homogeneous Coordinates", HWWS 1997).
#pragma once

#include "shared/lanes.h"
#include "shared/raster_params.h"

typedef struct Corners {
  real x, y, z, w;
} Corners;

// a b - c d, within 2^-23 of itself, and 0 only where it is 0 (Jeannerod, Louvet, Muller, "Further Analysis
// of Kahan's Algorithm for the Accurate Computation of 2 x 2 Determinants", 2013).
static inline real difference_of_products(real a, real b, real c, real d) {
  const real product = c * d, rest = fma(-c, d, product);
  return fma(a, b, -product) + rest;
}

static inline Corners chosen(mask_t first, Corners a, Corners b) {
  const Corners c = {first ? a.x : b.x, first ? a.y : b.y, first ? a.z : b.z, first ? a.w : b.w};
  return c;
}

// The corner whose value is the least.
static inline Corners min_corner(const Corners* v, const real* values) {
  const mask_t second = values[1] < values[0];
  const Corners c = chosen(second, v[1], v[0]);
  return chosen(values[2] < lane_min(values[1], values[0]), v[2], c);
}

// Deeper corners count as this deep, so that gradients stay finite. In real numbers no pixel changes: a
// corner has 2^-47 or more of a sample's weight, or none, so a sample off the edge between the other two is
// behind the far plane anyway.
#define DEEPEST (-1.8446744073709552e19f)  // -2^64

// The depth of the part in front of the near plane: for a corner behind it, the near plane's.
static inline real depth_of_corner(Corners v) {
  const real one = 1.0f, deepest = DEEPEST, depth = lane_max(lane_min(v.z * (one / v.w), one), deepest);
  return v.w > (real)(0.0f) ? depth : one;
}

// Beyond these, products overflow or are too small for all their digits.
#define LARGEST_SIZE 0x1p60f
#define LEAST_DISTANCE 0x1p-90f
#define LARGEST_DISTANCE 0x1p90f

// The change of depth per pixel to the right and up; infinite where floats do not reach far enough, or where
// the eye lies in the triangle's plane.
static inline void plane_gradients(const Corners* v, real* zx, real* zy, constant RasterParams* p) {
  const Corners o = v[0];
  const real ax = v[1].x - o.x, ay = v[1].y - o.y, az = v[1].z - o.z, aw = v[1].w - o.w;
  const real bx = v[2].x - o.x, by = v[2].y - o.y, bz = v[2].z - o.z, bw = v[2].w - o.w;
  const real nx = difference_of_products(ay, bw, aw, by), ny = difference_of_products(aw, bx, ax, bw),
             nw = difference_of_products(ax, by, ay, bx);
  real size[3];
  for (int k = 0; k < 3; ++k) size[k] = fabs(v[k].x) + fabs(v[k].y) + fabs(v[k].w);
  // The corner nearest to the eye is used: its distance from the plane loses the least by cancellation.
  const Corners near = min_corner(v, size);
  const real distance = fma(nx, near.x, fma(ny, near.y, nw * near.w)), per_distance = (real)(1.0f) / distance;
  real right = o.z * (nx * per_distance), up = o.z * (ny * per_distance);
  // Where the far plane is infinitely far all z are alike.
  const mask_t slanted = (az != (real)(0.0f)) | (bz != (real)(0.0f));
  if (any_lane(slanted)) {
    const real more_x = difference_of_products(az, difference_of_products(by, o.w, bw, o.y), bz,
                                               difference_of_products(ay, o.w, aw, o.y)),
               more_y = difference_of_products(az, difference_of_products(bw, o.x, bx, o.w), bz,
                                               difference_of_products(aw, o.x, ax, o.w));
    right = slanted ? fma(more_x, per_distance, right) : right;
    up = slanted ? fma(more_y, per_distance, up) : up;
  }
  const mask_t reached = (size[0] + size[1] + size[2] <= (real)(LARGEST_SIZE)) &
                         (fabs(distance) >= (real)(LEAST_DISTANCE)) &
                         (fabs(distance) <= (real)(LARGEST_DISTANCE));
  *zx = reached ? right * (256.0f / p->half_x) : (real)(INFINITY);
  *zy = reached ? up * (256.0f / p->half_y) : (real)(INFINITY);
}

// Depth in the plane at a place, 1/256 pixel from the image's lower left corner.
static inline real plane_depth_at(const Corners* v, const real* depths, real zx, real zy, whole x, whole y,
                                  constant RasterParams* p) {
  const real size[3] = {fabs(depths[0]), fabs(depths[1]), fabs(depths[2])};
  const Corners from = min_corner(v, size);  // whose own rounding counts the least
  // From the corner, which is not snapped, to the place, times w.
  const real right = difference_of_products(TO_REAL(x - (int)p->half_x), from.w, from.x, p->half_x),
             up = difference_of_products(TO_REAL(y - (int)p->half_y), from.w, from.y, p->half_y);
  return fma(zx, right * (1.0f / 256), fma(zy, up * (1.0f / 256), from.z)) / from.w;
}
