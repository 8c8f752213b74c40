// LANES segments that end at one light, and their tests against triangles and boxes.
//
// A light at a point (w 1) is the origin of all coordinates here: a segment goes from 0 to (x, y, z), its
// point, and ends at the share `end` of it. Towards a direction (w 0) a segment goes from its point along
// that direction, and coordinates stay the scene's.
//
// A triangle is met by the signs of four dot products a lane: with the planes through the light and each
// edge, and with its own. The planes are made once for all lanes, in double; swapping the two ends of an edge
// turns all signs, so that two triangles with a common edge never both miss a segment.
//
// What a box test rounds it covers itself: relative errors (less than 8 of 2^-24) by SLACK, that of the
// light's position by moving the box's sides outwards (`reach`). A triangle counts as met only if its own box
// is met too. Box tests are monotonic in the box, so the boxes around it are then met as well, and no answer
// depends on the tree.
#pragma once

#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "kernels/common/pack.h"
#include "shared/ray_records.h"
#include "shared/real.h"

#define SLACK 1.000001f
#define LEAST_STEP 1e-20f  // of a direction along an axis: 1 over it stays finite
#define FAR_AWAY 0x1p60f   // metres: where segments without an end do end

#if LANES == 1
#define lane_bits(m) ((m) != 0 ? 1u : 0u)
#else
#define lane_bits mask_bits
#endif

// w 1: a point, relative to the scene's origin; w 0: a unit direction to the light.
typedef struct RaySource {
  double x, y, z, w;
} RaySource;

typedef struct RayPacket {
  RaySource light;
  real x, y, z;
  real end;  // below 0: this lane has no segment, or has its answer
  // A box's side at `low` is crossed at the share low * inverse_x + from_x of a segment.
  real inverse_x, inverse_y, inverse_z, from_x, from_y, from_z;
  float low_x, low_y, low_z, high_x, high_y, high_z;  // what is taken from a box's lower and upper sides
} RayPacket;

static inline real inverse_step(real x) { return 1.0f / (fabs(x) < LEAST_STEP ? REAL(LEAST_STEP) : x); }

// to - from in two steps, since a double that is not a float lies between: to within 2^-23 of the difference.
static inline real from_double(real to, double from) {
  const float near = (float)from;
  return (to - near) - (float)(from - near);
}

// `extent`: the greatest coordinate of the scene's triangles.
static inline RayPacket ray_packet(RaySource light, Real3 to, real gap, mask_t active, float extent) {
  RayPacket p;
  p.light = light;
  if (light.w != 0) {
    p.x = from_double(to.x, light.x), p.y = from_double(to.y, light.y), p.z = from_double(to.z, light.z);
    p.end = 1.0f - gap / sqrt(fma(p.z, p.z, fma(p.y, p.y, p.x * p.x)));
    p.inverse_x = inverse_step(p.x), p.inverse_y = inverse_step(p.y), p.inverse_z = inverse_step(p.z);
    p.from_x = p.from_y = p.from_z = 0.0f;
    const float x = (float)light.x, y = (float)light.y, z = (float)light.z;
    const float reach = 0x1p-22f * (fabs(x) + fabs(y) + fabs(z));
    p.low_x = x + reach, p.low_y = y + reach, p.low_z = z + reach;
    p.high_x = x - reach, p.high_y = y - reach, p.high_z = z - reach;
  } else {
    const float x = (float)light.x, y = (float)light.y, z = (float)light.z;
    p.x = fma(gap, REAL(x), to.x), p.y = fma(gap, REAL(y), to.y), p.z = fma(gap, REAL(z), to.z);
    p.end = 1.0f;
    p.inverse_x = inverse_step(REAL(x * FAR_AWAY)), p.inverse_y = inverse_step(REAL(y * FAR_AWAY));
    p.inverse_z = inverse_step(REAL(z * FAR_AWAY));
    p.from_x = -p.x * p.inverse_x, p.from_y = -p.y * p.inverse_y, p.from_z = -p.z * p.inverse_z;
    p.low_x = p.low_y = p.low_z = 0x1p-20f * extent;
    p.high_x = p.high_y = p.high_z = -0x1p-20f * extent;
  }
  p.end = active ? p.end : REAL(-1.0f);
  return p;
}

// At the plane's side, `offset` added: x a + y b + z c.
static inline real ray_side(const RayPacket* p, float a, float b, float c, float offset) {
  return fma(p->z, REAL(c), fma(p->y, REAL(b), fma(p->x, REAL(a), REAL(offset))));
}

static inline mask_t meets_box(const RayPacket* p, float low_x, float low_y, float low_z, float high_x,
                               float high_y, float high_z) {
  const real x0 = fma(p->inverse_x, REAL(low_x - p->low_x), p->from_x),
             x1 = fma(p->inverse_x, REAL(high_x - p->high_x), p->from_x),
             y0 = fma(p->inverse_y, REAL(low_y - p->low_y), p->from_y),
             y1 = fma(p->inverse_y, REAL(high_y - p->high_y), p->from_y),
             z0 = fma(p->inverse_z, REAL(low_z - p->low_z), p->from_z),
             z1 = fma(p->inverse_z, REAL(high_z - p->high_z), p->from_z);
  const real enter =
      lane_max(lane_max(lane_min(x0, x1), lane_min(y0, y1)), lane_max(lane_min(z0, z1), REAL(0.0f)));
  const real leave =
      lane_min(lane_min(lane_max(x0, x1), lane_max(y0, y1)), lane_min(lane_max(z0, z1), p->end));
  return enter <= leave * SLACK;
}

typedef struct RayPlane {
  double x, y, z, offset;
} RayPlane;

// Through the light and two corners, which are relative to a light at a point.
static inline RayPlane edge_plane(RaySource light, double bx, double by, double bz, double cx, double cy,
                                  double cz) {
  const double x = by * cz - bz * cy, y = bz * cx - bx * cz, z = bx * cy - by * cx;
  if (light.w != 0) {
    const RayPlane p = {x, y, z, 0};
    return p;
  }
  const double ux = bx - cx, uy = by - cy, uz = bz - cz;
  const RayPlane p = {light.y * uz - light.z * uy, light.z * ux - light.x * uz, light.x * uy - light.y * ux,
                      -(light.x * x + light.y * y + light.z * z)};
  return p;
}

static inline real plane_side(const RayPacket* p, RayPlane plane, double turn) {
  return ray_side(p, (float)(plane.x * turn), (float)(plane.y * turn), (float)(plane.z * turn),
                  (float)(plane.offset * turn));
}

// Of the corners, where a segment crosses; they add up to anything.
typedef struct RayWeights {
  real first, second, third;
} RayWeights;

// Lanes whose segments cross the triangle. A light in its plane sees nothing of it. Edges are computed only if
// a segment reaches the plane.
static inline mask_t meets_triangle(const RayPacket* p, global const RayTriangle* t, RayWeights* weights) {
  const RaySource l = p->light;
  const bool point = l.w != 0;
  const double lx = point ? l.x : 0, ly = point ? l.y : 0, lz = point ? l.z : 0;
  const double nx = t->normal[0], ny = t->normal[1], nz = t->normal[2];
  const double ax = t->corners[0] - lx, ay = t->corners[1] - ly, az = t->corners[2] - lz;
  const double distance = nx * ax + ny * ay + nz * az,
               facing = point ? distance : -(nx * l.x + ny * l.y + nz * l.z);
  if (!(facing > 0 || facing < 0)) return (mask_t)(0);
  const double turn = facing < 0 ? -1 : 1;
  const real past = fma(p->end, ray_side(p, (float)(nx * turn), (float)(ny * turn), (float)(nz * turn), 0.0f),
                        REAL((float)(-distance * turn)));
  const real live = lane_min(past, p->end);
  if (!any_lane(live >= 0.0f)) return (mask_t)(0);
  const double bx = t->corners[3] - lx, by = t->corners[4] - ly, bz = t->corners[5] - lz;
  const double cx = t->corners[6] - lx, cy = t->corners[7] - ly, cz = t->corners[8] - lz;
  weights->first = plane_side(p, edge_plane(l, bx, by, bz, cx, cy, cz), turn);
  weights->second = plane_side(p, edge_plane(l, cx, cy, cz, ax, ay, az), turn);
  weights->third = plane_side(p, edge_plane(l, ax, ay, az, bx, by, bz), turn);
  return lane_min(lane_min(weights->first, weights->second), lane_min(weights->third, live)) >= 0.0f;
}

static inline float least_of_3(float a, float b, float c) { return fmin(fmin(a, b), c); }
static inline float greatest_of_3(float a, float b, float c) { return fmax(fmax(a, b), c); }

static inline mask_t meets_own_box(const RayPacket* p, global const float* c) {
  return meets_box(p, least_of_3(c[0], c[3], c[6]), least_of_3(c[1], c[4], c[7]),
                   least_of_3(c[2], c[5], c[8]), greatest_of_3(c[0], c[3], c[6]),
                   greatest_of_3(c[1], c[4], c[7]), greatest_of_3(c[2], c[5], c[8]));
}
