// Draws triangles into a tile of a shadow map's face: draw_faces.cl says how. LANES triangles are set up at
// once, and LANES texels of a row drawn at once.
#pragma once

#include "kernels/rays/rays.h"
#include "kernels/shadow_maps/face_tile.h"

// A triangle a lane, as all texels of the tile see it.
typedef struct TriangleLanes {
  Real3 p, q, r;  // planes through the light and an edge: above 0 inside
  Real3 normal;   // on the side that the light sees
  real offset;    // normal . corner
  real nearest, furthest;
  whole left, right, low, high;  // texels of the face that it may cover
} TriangleLanes;

static inline real lane_along(float3 axis, Real3 v) { return axis.x * v.x + axis.y * v.y + axis.z * v.z; }

static inline Real3 in_face(const FaceTile* t, Real3 corner) {
  const Real3 p = real3(corner.x - t->from.x, corner.y - t->from.y, corner.z - t->from.z);
  return real3(lane_along(t->right, p), lane_along(t->up, p), lane_along(t->ahead, p));
}

// Where a triangle crosses the light's plane, at a corner behind it and one in front, its image has no end.
static inline void bound_crossing(real x, real z, real x_ahead, real z_ahead, real* low, real* high) {
  const real a = x * z_ahead, b = x_ahead * z, slack = ROUNDING * (fabs(a) + fabs(b));
  const mask_t crosses = (z <= 0.0f) & (z_ahead > 0.0f);
  *low = (crosses & (a - b <= slack)) ? REAL(-INFINITY) : *low;
  *high = (crosses & (a - b >= -slack)) ? REAL(INFINITY) : *high;
}

// Texels along an axis whose centres may see triangles of which x are the corners' coordinates along it.
static inline void bound_axis(const FaceTile* t, Real3 x, Real3 z, whole* first, whole* last) {
  Real3 u = x;
  real low = REAL(INFINITY), high = REAL(-INFINITY);
  if (!t->parallel) u = real3(x.x / z.x, x.y / z.y, x.z / z.z);
  const mask_t crossing = t->parallel ? (mask_t)(0) : lane_min(lane_min(z.x, z.y), z.z) <= 0.0f;
#define BOUND_CORNER(k)                                                                \
  {                                                                                    \
    const mask_t seen = t->parallel ? (mask_t)(-1) : z.k > 0.0f;                       \
    low = (seen & (u.k < low)) ? u.k : low, high = (seen & (u.k > high)) ? u.k : high; \
  }
  BOUND_CORNER(x)
  BOUND_CORNER(y)
  BOUND_CORNER(z)
  if (any_lane(crossing)) {
    bound_crossing(x.x, z.x, x.y, z.y, &low, &high);
    bound_crossing(x.x, z.x, x.z, z.z, &low, &high);
    bound_crossing(x.y, z.y, x.x, z.x, &low, &high);
    bound_crossing(x.y, z.y, x.z, z.z, &low, &high);
    bound_crossing(x.z, z.z, x.x, z.x, &low, &high);
    bound_crossing(x.z, z.z, x.y, z.y, &low, &high);
  }
  const float middle = 0.5f * (float)t->size, to_texels = middle / t->extent;
  const real most = REAL((float)t->size), least = REAL(-1.0f);
  low = -lane_floor((0.5f + TEXEL_ROUNDING - middle) - low * to_texels);
  high = lane_floor(high * to_texels + (middle - 0.5f + TEXEL_ROUNDING));
  *first = max(*first, TO_WHOLE(lane_max(lane_min(low, most), least)));
  *last = min(*last, TO_WHOLE(lane_max(lane_min(high, most), least)));
}

// Lanes whose bounds all lie outside of one edge. Roundings are monotonic: what draw_columns()
// computes there is no more than this.
static inline mask_t out_of_edge(const FaceTile* t, Real3 p, const TriangleLanes* d) {
  const real u = t->first_u + t->step * TO_REAL(p.x > 0.0f ? d->right : d->left),
             v = t->first_u + t->step * TO_REAL(p.y > 0.0f ? d->high : d->low);
  return p.x * u + (p.y * v + p.z) < 0.0f;
}

// Twice a x b, from the edge itself: of two long vectors side by side the product would lose most of its
// digits.
static inline Real3 edge_plane_of(Real3 a, Real3 b, real turn) {
  return scale3(cross3(add3(a, scale3(b, REAL(-1.0f))), add3(a, b)), turn);
}

// The test that may_change() makes of boxes, of the triangle's own: what a face holds then depends on no box
// of the tree.
static inline mask_t in_range(const FaceTile* t, const Real3 corners[3]) {
  Real3 off = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
#define OFF_BOX(axis)                                                                                     \
  {                                                                                                       \
    const real a = corners[0].axis - t->from.axis, b = corners[1].axis - t->from.axis,                    \
               c = corners[2].axis - t->from.axis;                                                        \
    off.axis = lane_max(lane_max(lane_min(lane_min(a, b), c), -lane_max(lane_max(a, b), c)), REAL(0.0f)); \
  }
  OFF_BOX(x)
  OFF_BOX(y)
  OFF_BOX(z)
  return dot3(off, off) <= t->range * t->range * 1.00001f;
}

// Lanes that may change a texel of the tile.
static inline mask_t set_up(const FaceTile* t, const Real3 corners[3], TriangleLanes* d) {
  const Real3 a = in_face(t, corners[0]), b = in_face(t, corners[1]), c = in_face(t, corners[2]);
  const Real3 z = real3(a.z, b.z, c.z);
  d->furthest = lane_max(lane_max(z.x, z.y), z.z);
  const real nearest = lane_min(lane_min(z.x, z.y), z.z);
  d->nearest = lane_max(nearest, REAL(0.0f));
  mask_t drawn = (d->furthest > 0.0f) & (nearest <= t->range) & (texel_value(t, d->nearest) < t->farthest);
  if (!t->parallel) drawn &= in_range(t, corners);
  if (!any_lane(drawn)) return drawn;
  d->left = (whole)(t->x);
  d->right = (whole)(t->x + t->side - 1);
  d->low = (whole)(t->y);
  d->high = (whole)(t->y + t->side - 1);
  bound_axis(t, real3(a.x, b.x, c.x), z, &d->left, &d->right);
  bound_axis(t, real3(a.y, b.y, c.y), z, &d->low, &d->high);
  drawn &= (d->left <= d->right) & (d->low <= d->high);
  if (!any_lane(drawn)) return drawn;
  const Real3 back = scale3(a, REAL(-1.0f)), normal = cross3(add3(b, back), add3(c, back));
  const real offset = dot3(normal, a), facing = t->parallel ? normal.z : offset;
  drawn &= (facing > 0.0f) | (facing < 0.0f);  // else the light lies in its plane and sees nothing of it
  const real turn = facing < 0.0f ? REAL(-1.0f) : REAL(1.0f);
  d->normal = scale3(normal, turn);
  d->offset = turn * offset;
  Real3 ea = a, eb = b, ec = c;
  if (t->parallel) ea.z = eb.z = ec.z = REAL(1.0f);
  d->p = edge_plane_of(eb, ec, turn);
  d->q = edge_plane_of(ec, ea, turn);
  d->r = edge_plane_of(ea, eb, turn);
  return drawn & ~(out_of_edge(t, d->p, d) | out_of_edge(t, d->q, d) | out_of_edge(t, d->r, d));
}

// The value of one of these triangles.
#define LANE_OF(v) (((const float*)&(v))[lane])
#define WHOLE_LANE_OF(v) (((const int*)&(v))[lane])
typedef struct Triangle {
  float3 p, q, r, normal;
  float offset, nearest, furthest;
  int left, right, low, high, place;
  bool masked;
} Triangle;

static inline float3 lane_of3(const Real3* v, uint lane) {
  return (float3)(LANE_OF(v->x), LANE_OF(v->y), LANE_OF(v->z));
}

static inline Triangle triangle_of_lane(const RayScene* scene, const TriangleLanes* d, int place, uint lane) {
  const Triangle t = {lane_of3(&d->p, lane),
                      lane_of3(&d->q, lane),
                      lane_of3(&d->r, lane),
                      lane_of3(&d->normal, lane),
                      LANE_OF(d->offset),
                      LANE_OF(d->nearest),
                      LANE_OF(d->furthest),
                      WHOLE_LANE_OF(d->left),
                      WHOLE_LANE_OF(d->right),
                      WHOLE_LANE_OF(d->low),
                      WHOLE_LANE_OF(d->high),
                      place,
                      (scene->triangles[place].number & RAY_MASKED) != 0};
  return t;
}

// LANES columns of texels from packet x of the tile on, in the rows of the triangle's bounds.
static inline void draw_columns(const RayScene* scene, FaceTile* t, const Triangle* d, int x) {
  const whole column = (whole)(t->x + x * LANES) + LANE_INDICES;
  const mask_t in_bounds = (column >= (whole)(d->left)) & (column <= (whole)(d->right));
  const float first_u = t->first_u, step = t->step, range = t->range;
  const bool parallel = t->parallel;
  const real u = first_u + step * TO_REAL(column);
  const real pu = d->p.x * u, qu = d->q.x * u, ru = d->r.x * u, nu = d->normal.x * u;
  OVER_FEW for (int y = FIRST_OF(d->low - t->y); y <= LAST_OF(d->high - t->y); ++y) {
    const float v = first_u + step * (float)(t->y + y);
    const real e0 = pu + (d->p.y * v + d->p.z), e1 = qu + (d->q.y * v + d->q.z),
               e2 = ru + (d->r.y * v + d->r.z);
    mask_t inside = in_bounds & (lane_min(lane_min(e0, e1), e2) >= 0.0f);
#if LANES == 1
    inside &= (t->y + y >= d->low) & (t->y + y <= d->high);
#endif
    if (!any_lane(inside)) continue;
#ifdef RAYS_MASKS
    if (d->masked) inside &= hides_by_mask(&scene->masks, d->place, e0, e1, e2);
#endif
    const real at_plane = parallel ? (d->offset - nu - d->normal.y * v) / d->normal.z
                                   : d->offset / (nu + (d->normal.y * v + d->normal.z));
    const real distance = lane_min(lane_max(at_plane, REAL(d->nearest)), REAL(d->furthest));
    const real value = texel_value(t, distance);
    real* texel = t->texels + y * PACKETS + x;
    inside &= (distance <= range) & (value < *texel);
    *texel = inside ? value : *texel;
  }
}

static inline float greatest_lane(real v) {
#if LANES == 16
  const float8 a = max(v.lo, v.hi);
  const float4 b = max(a.lo, a.hi);
  return max(max(b.x, b.y), max(b.z, b.w));
#else
  return v;
#endif
}

static inline void draw_texels(const RayScene* scene, FaceTile* t, const Triangle* d) {
  const int first = (d->left - t->x) / LANES, last = (d->right - t->x) / LANES;
  OVER_FEW for (int x = FIRST_OF(first); x <= LAST_OF(last); ++x) draw_columns(scene, t, d, x);
}

// `count` of LANES triangles.
static inline void draw_triangles(const RayScene* scene, const int places[LANES], int count, FaceTile* t) {
#if LANES == 16
  float corners[9][16];
  for (int lane = 0; lane < 16; ++lane) {
    global const float* from = scene->triangles[places[lane < count ? lane : 0]].corners;
    for (int k = 0; k < 9; ++k) corners[k][lane] = from[k];
  }
#define CORNER_LANES(k) \
  real3(vload16(0, corners[3 * k]), vload16(0, corners[3 * k + 1]), vload16(0, corners[3 * k + 2]))
#else
  global const float* corners = scene->triangles[places[0]].corners;
#define CORNER_LANES(k) real3(corners[3 * k], corners[3 * k + 1], corners[3 * k + 2])
#endif
  const Real3 placed[3] = {CORNER_LANES(0), CORNER_LANES(1), CORNER_LANES(2)};
  TriangleLanes d;
  uint left = lane_bits(set_up(t, placed, &d)) & ((1u << count) - 1u);
  if (left == 0) return;
  for (; left != 0; left &= left - 1) {
    const uint lane = LANES == 1 ? 0 : lowest_bit(left);
    const Triangle one = triangle_of_lane(scene, &d, places[lane], lane);
    draw_texels(scene, t, &one);
    ++t->drawn;
  }
  if (t->drawn < TILE * PACKETS / 16) return;
  t->drawn = 0;
  real farthest = t->texels[0];
  OVER_FEW for (int i = 1; i < TILE * PACKETS; ++i) farthest = lane_max(farthest, t->texels[i]);
  t->farthest = greatest_lane(farthest);
}
