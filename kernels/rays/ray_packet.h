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
// A box test covers its own rounding: relative errors (less than 8 of 2^-24) by SLACK, the error of a
// segment's start by moving the box's sides outwards (`reach`). A triangle counts as met only if its own box
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
#define lanes_of(bits) ((int)(bits))
#else
#define lane_bits mask_bits
#define lanes_of(bits) (((int16)((int)(bits)) >> LANE_INDEX & 1) != 0)
#endif

// w 1: a point, relative to the scene's origin; w 0: a unit direction to the light.
typedef struct RaySource {
  double x, y, z, w;
} RaySource;

typedef struct RayPacket {
  RaySource light;
  real x, y, z;
  real end;  // below 0: this lane has no segment, or has its answer
  // Segments of a packet that is traced go the same way along each axis. A box's plane at p is crossed at the
  // share inverse * p + enter of a segment where they come in, inverse * p + leave where they go out.
  real inverse_x, inverse_y, inverse_z;
  real enter_x, enter_y, enter_z, leave_x, leave_y, leave_z;
  uint down;  // 1, 2, 4: they go down x, y, z
#ifdef RAYS_VEILS
  whole veil;  // of blended triangles that are met (kernels/rays/ray_masks.h)
#endif
} RayPacket;

static inline real inverse_step(real x) { return 1.0f / (fabs(x) < LEAST_STEP ? REAL(LEAST_STEP) : x); }

// to - from in two steps, since a double that is not a float lies between: to within 2^-23 of the difference.
static inline real from_double(real to, double from) {
  const float near = (float)from;
  return (to - near) - (float)(from - near);
}

// Where planes are crossed, for segments that begin at `from` or, along `to`, up to `reach` beside it.
#define CROSSINGS(axis, from)                                                                \
  {                                                                                          \
    const real i = p->inverse_##axis, low = -i * (from - reach), high = -i * (from + reach); \
    p->enter_##axis = lane_min(low, high), p->leave_##axis = lane_max(low, high);            \
  }

static inline void set_packet(RayPacket* p, RaySource light, Real3 to, real gap) {
  const float x = (float)light.x, y = (float)light.y, z = (float)light.z;
  p->light = light;
  if (light.w != 0) {
    p->x = from_double(to.x, light.x);
    p->y = from_double(to.y, light.y);
    p->z = from_double(to.z, light.z);
    p->end = 1.0f - gap / sqrt(fma(p->z, p->z, fma(p->y, p->y, p->x * p->x)));
    p->inverse_x = inverse_step(p->x);
    p->inverse_y = inverse_step(p->y);
    p->inverse_z = inverse_step(p->z);
    const float reach = 0x1p-22f * (fabs(x) + fabs(y) + fabs(z));
    CROSSINGS(x, x)
    CROSSINGS(y, y)
    CROSSINGS(z, z)
  } else {
    p->x = fma(gap, REAL(x), to.x);
    p->y = fma(gap, REAL(y), to.y);
    p->z = fma(gap, REAL(z), to.z);
    const real reach = 0x1p-20f * (fabs(p->x) + fabs(p->y) + fabs(p->z));
    p->end = 1.0f;
    p->inverse_x = inverse_step(REAL(x * FAR_AWAY));
    p->inverse_y = inverse_step(REAL(y * FAR_AWAY));
    p->inverse_z = inverse_step(REAL(z * FAR_AWAY));
    CROSSINGS(x, p->x)
    CROSSINGS(y, p->y)
    CROSSINGS(z, p->z)
  }
}

// Planes where segments of this packet come into a box and where they go out.
static inline mask_t meets_box(const RayPacket* p, float in_x, float in_y, float in_z, float out_x,
                               float out_y, float out_z) {
  const real enter =
      lane_max(lane_max(fma(p->inverse_x, REAL(in_x), p->enter_x), fma(p->inverse_y, REAL(in_y), p->enter_y)),
               lane_max(fma(p->inverse_z, REAL(in_z), p->enter_z), REAL(0.0f)));
  const real leave = lane_min(
      lane_min(fma(p->inverse_x, REAL(out_x), p->leave_x), fma(p->inverse_y, REAL(out_y), p->leave_y)),
      lane_min(fma(p->inverse_z, REAL(out_z), p->leave_z), p->end));
  return enter <= leave * SLACK;
}

// x a + y b + z c + offset.
static inline real ray_side(Real3 at, float a, float b, float c, float offset) {
  return fma(at.z, REAL(c), fma(at.y, REAL(b), fma(at.x, REAL(a), REAL(offset))));
}

typedef struct RayPlane {
  double x, y, z, offset;
} RayPlane;

// Through the light and two corners, which are relative to a light at a point.
static inline RayPlane edge_plane(RaySource light, bool point, double bx, double by, double bz, double cx,
                                  double cy, double cz) {
  if (point) {
    const RayPlane p = {by * cz - bz * cy, bz * cx - bx * cz, bx * cy - by * cx, 0};
    return p;
  }
  const double ux = bx - cx, uy = by - cy, uz = bz - cz;
  const double x = light.y * uz - light.z * uy, y = light.z * ux - light.x * uz,
               z = light.x * uy - light.y * ux;
  // Half way between both ends: b x c would cancel where they are far away.
  const RayPlane p = {x, y, z, -0.5 * (x * (bx + cx) + y * (by + cy) + z * (bz + cz))};
  return p;
}

static inline real plane_side(Real3 at, RayPlane plane, double turn) {
  return ray_side(at, (float)(plane.x * turn), (float)(plane.y * turn), (float)(plane.z * turn),
                  (float)(plane.offset * turn));
}

// Lanes whose segments cross the triangle. A light in its plane sees nothing of it. Edges are computed only
// if a segment reaches the plane. `weights`, unless it is null: of the corners, where the segments cross;
// they add up to anything.
static inline __attribute__((always_inline)) mask_t meets_triangle(RaySource l, const bool point,
                                                                   global const RayTriangle* t, Real3 at,
                                                                   real end, Real3* weights) {
  const double lx = point ? l.x : 0, ly = point ? l.y : 0, lz = point ? l.z : 0;
  const double nx = t->normal[0], ny = t->normal[1], nz = t->normal[2];
  const double ax = t->corners[0] - lx, ay = t->corners[1] - ly, az = t->corners[2] - lz;
  const double distance = nx * ax + ny * ay + nz * az,
               facing = point ? distance : -(nx * l.x + ny * l.y + nz * l.z);
  if (!(facing > 0 || facing < 0)) return (mask_t)(0);
  const double turn = facing < 0 ? -1 : 1;
  const real past = fma(end, ray_side(at, (float)(nx * turn), (float)(ny * turn), (float)(nz * turn), 0.0f),
                        REAL((float)(-distance * turn)));
  const real live = lane_min(past, end);
  if (!any_lane(live >= 0.0f)) return (mask_t)(0);
  const double bx = t->corners[3] - lx, by = t->corners[4] - ly, bz = t->corners[5] - lz;
  const double cx = t->corners[6] - lx, cy = t->corners[7] - ly, cz = t->corners[8] - lz;
  // As seen from each corner: where they disagree, a light at a corner or an edge is in the plane but for
  // rounding.
  if (point && !((nx * bx + ny * by + nz * bz) * turn > 0 && (nx * cx + ny * cy + nz * cz) * turn > 0))
    return (mask_t)(0);
  const real u = plane_side(at, edge_plane(l, point, bx, by, bz, cx, cy, cz), turn),
             v = plane_side(at, edge_plane(l, point, cx, cy, cz, ax, ay, az), turn),
             w = plane_side(at, edge_plane(l, point, ax, ay, az, bx, by, bz), turn);
  if (weights) *weights = real3(u, v, w);
  return lane_min(lane_min(u, v), lane_min(w, live)) >= 0.0f;
}

// On CPUs a call: inlined, its registers displace those of the walk through the tree.
#if LANES == 16
#define RAYS_CALL static __attribute__((noinline))
#else
#define RAYS_CALL static inline
#endif
RAYS_CALL mask_t meets_from_point(double x, double y, double z, global const RayTriangle* t, Real3 at,
                                  real end) {
  const RaySource light = {x, y, z, 1};
  return meets_triangle(light, true, t, at, end, 0);
}
RAYS_CALL mask_t meets_from_direction(double x, double y, double z, global const RayTriangle* t, Real3 at,
                                      real end) {
  const RaySource light = {x, y, z, 0};
  return meets_triangle(light, false, t, at, end, 0);
}

static inline float min_of_3(float a, float b, float c) {
  const float d = a < b ? a : b;
  return d < c ? d : c;
}
static inline float max_of_3(float a, float b, float c) {
  const float d = a > b ? a : b;
  return d > c ? d : c;
}

static inline mask_t meets_own_box(const RayPacket* p, global const float* c) {
  float in[3], out[3];
  for (int k = 0; k < 3; ++k) {
    const float low = min_of_3(c[k], c[3 + k], c[6 + k]), high = max_of_3(c[k], c[3 + k], c[6 + k]);
    const bool down = p->down >> k & 1;
    in[k] = down ? high : low;
    out[k] = down ? low : high;
  }
  return meets_box(p, in[0], in[1], in[2], out[0], out[1], out[2]);
}
