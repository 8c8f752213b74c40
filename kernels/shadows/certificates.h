// Certificates: for a light and a piece of a triangle, the triangles that may hide a point of the piece. They
// are kept while nothing moves (passes/shadows/certificates.h); answers are those of rays to the bit.
//
// A piece is the part of a triangle in a cell of the world's grid. The points that belong to it are those
// that in_piece (cpu/tile_pieces.h) lets in: floats, near the triangle's plane and a little inside its edges.
// polygon_of holds them all. A triangle is left out only if the ray's own arithmetic (kernels/rays/) misses it
// from every such point, all of that arithmetic's roundings counted in:
// - Its box, or one around it, lies beyond a plane that all segments from the light to the polygon are on one
//   side of. The test of boxes meets nothing further than 2^-19 of the segment's length from the segment,
//   plus 2^-21 of the light's coordinates.
// - One of the four dot products of the triangle's test is negative at each corner of the polygon, hence in
//   it, by more than 2^-19 of the products' absolute sum.
// - All its corners lie beyond such a plane (corners_beyond).
// A triangle hides the whole piece if all four are positive by as much.
#pragma once

#include "kernels/shadows/certificate_table.h"
#include "kernels/shadows/receivers.h"

// Of a cell's edge: how much wider the polygon's cell is.
#define EDGE 0x1p-8f
#define MOST_SEEN 32  // triangles that may hide a point, after which nothing more is tried

typedef struct Polygon {
  double at[12][3];
  uint count;
} Polygon;

// Keeps where the function is not negative (Sutherland, Hodgman, "Reentrant Polygon Clipping", 1974).
static void clip(Polygon* polygon, double a, double b, double c, double offset) {
  const Polygon from = *polygon;
  double side[12];
  for (uint i = 0; i < from.count; ++i)
    side[i] = a * from.at[i][0] + b * from.at[i][1] + c * from.at[i][2] + offset;
  uint count = 0;
  for (uint i = 0; i < from.count; ++i) {
    const uint next = i + 1 == from.count ? 0 : i + 1;
    if (side[i] >= 0) {
      for (int k = 0; k < 3; ++k) polygon->at[count][k] = from.at[i][k];
      ++count;
    }
    if ((side[i] >= 0) != (side[next] >= 0)) {
      const double t = side[i] / (side[i] - side[next]);
      for (int k = 0; k < 3; ++k)
        polygon->at[count][k] = from.at[i][k] + t * (from.at[next][k] - from.at[i][k]);
      ++count;
    }
  }
  polygon->count = count;
}

// The axis along which a triangle's points are moved onto its plane: that of its normal's greatest component.
static inline int greatest_axis(global const RayTriangle* t) {
  const float x = fabs((float)t->normal[0]), y = fabs((float)t->normal[1]), z = fabs((float)t->normal[2]);
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

static inline float edge_of_piece(int exponent) { return as_float((127 + exponent) << 23); }

// How far a point of the piece may be from the plane, along the axis: r->slack of receivers.h, which is the
// same bound of each point.
static inline float off_plane(global const RayTriangle* t, const Piece* piece) {
  const float edge = edge_of_piece(piece->exponent);
  const float x = edge * (piece->x + 0.5f), y = edge * (piece->y + 0.5f), z = edge * (piece->z + 0.5f);
  return 0x1p-20f * (fabs(x) + fabs(y) + fabs(z) + fabs(x - t->corners[0]) + fabs(y - t->corners[1]) +
                     fabs(z - t->corners[2]) + 16.0f * edge);
}

// How far within the triangle's edges its points are, so that neighbours at an edge do not count as hiding
// them.
static inline float inner_edge(global const RayTriangle* t, const Piece* piece) {
  return 8.0f * off_plane(t, piece);
}

// Of a triangle: the plane's part in the cell, whose sides are EDGE further out, cut by the edges, moved in.
static void polygon_of(Polygon* polygon, global const RayTriangle* t, const Piece* piece) {
  const double edge = edge_of_piece(piece->exponent), out = (double)EDGE * edge;
  const double low[3] = {piece->x * edge - out, piece->y * edge - out, piece->z * edge - out};
  const double high[3] = {low[0] + edge + 2 * out, low[1] + edge + 2 * out, low[2] + edge + 2 * out};
  const int k = greatest_axis(t), u = (k + 1) % 3, v = (k + 2) % 3;
  const double by_u = -t->normal[u] / t->normal[k], by_v = -t->normal[v] / t->normal[k];
  polygon->count = 4;
  for (uint i = 0; i < 4; ++i) {
    const double at_u = i == 1 || i == 2 ? high[u] : low[u], at_v = i >= 2 ? high[v] : low[v];
    polygon->at[i][u] = at_u, polygon->at[i][v] = at_v;
    polygon->at[i][k] = t->corners[k] + by_u * (at_u - t->corners[u]) + by_v * (at_v - t->corners[v]);
  }
  double f[3] = {0, 0, 0};
  f[k] = 1;
  clip(polygon, f[0], f[1], f[2], -low[k]);
  clip(polygon, -f[0], -f[1], -f[2], high[k]);
  const double turn = t->normal[k] < 0 ? -1 : 1;
  for (uint i = 0; i < 3 && polygon->count != 0; ++i) {
    global const float *a = t->corners + 3 * i, *b = t->corners + 3 * ((i + 1) % 3);
    const double du = ((double)b[u] - a[u]) * turn, dv = ((double)b[v] - a[v]) * turn;
    const double size = (du < 0 ? -du : du) + (dv < 0 ? -dv : dv);
    f[u] = -dv, f[v] = du, f[k] = 0;
    clip(polygon, f[0], f[1], f[2], dv * a[u] - du * a[v] - inner_edge(t, piece) * size);
  }
}

// All segments from the light to a polygon.
typedef struct Shaft {
  Real3 corners;            // relative to the light; the first one again where there are fewer
  Real3 above, below;       // positive and negative parts of planes' normals, of size 1: |x| + |y| + |z|
  real bound;               // no point of a segment is above this, by as much as boxes may be met
  float x, y, z;            // the light
  float extent[3];          // of the segments along each axis
  float nearest, farthest;  // lengths of segments, at least and at most
  float gap_low, gap_high;  // what they end before, at least and at most
  float off;                // how far a point may be from the polygon
  float sum;                // of the greatest coordinates
} Shaft;

static inline float greatest_of(real v) {
  const float8 a = max(v.lo, v.hi);
  const float4 b = max(a.lo, a.hi);
  return max(max(b.x, b.y), max(b.z, b.w));
}
static inline float least_of(real v) { return -greatest_of(-v); }

// Planes through the light and each edge, then one across each axis on both sides, and the polygon's own. Any
// plane would do, since its bound is taken from all corners.
static void set_shaft(Shaft* s, const RayScene* scene, global const RayTriangle* t, const Piece* piece,
                      const Polygon* polygon, global const ShadowLight* l) {
  float x[16], y[16], z[16], nx[16], ny[16], nz[16];
  const uint count = polygon->count;
  for (uint i = 0; i < 16; ++i) {
    const uint from = i < count ? i : 0;
    x[i] = (float)(polygon->at[from][0] - l->x), y[i] = (float)(polygon->at[from][1] - l->y);
    z[i] = (float)(polygon->at[from][2] - l->z);
  }
  s->corners = real3(vload16(0, x), vload16(0, y), vload16(0, z));
  s->x = (float)l->x, s->y = (float)l->y, s->z = (float)l->z;
  s->sum = scene->extent + fabs(s->x) + fabs(s->y) + fabs(s->z);
  s->off = off_plane(t, piece) + 0x1p-22f * s->sum;
  s->extent[0] = greatest_of(fabs(s->corners.x)) + s->off;
  s->extent[1] = greatest_of(fabs(s->corners.y)) + s->off;
  s->extent[2] = greatest_of(fabs(s->corners.z)) + s->off;
  const real squared =
      fma(s->corners.x, s->corners.x, fma(s->corners.y, s->corners.y, s->corners.z * s->corners.z));
  s->farthest = sqrt(greatest_of(squared)) * 1.000001f + 2.0f * s->off;
  const float box_x = max(max(least_of(s->corners.x), -greatest_of(s->corners.x)), 0.0f),
              box_y = max(max(least_of(s->corners.y), -greatest_of(s->corners.y)), 0.0f),
              box_z = max(max(least_of(s->corners.z), -greatest_of(s->corners.z)), 0.0f);
  s->nearest = sqrt(box_x * box_x + box_y * box_y + box_z * box_z) * 0.999999f - 2.0f * s->off;
  s->gap_low = 0.999999e-3f;
  s->gap_high = 1.000001e-3f + 1.001f * off_plane(t, piece);  // which holds 2^-20 of a point's distance
  for (uint i = 0; i < 16; ++i) {
    const uint next = i + 1 < count ? i + 1 : 0;
    if (i < count) {
      nx[i] = y[i] * z[next] - z[i] * y[next], ny[i] = z[i] * x[next] - x[i] * z[next];
      nz[i] = x[i] * y[next] - y[i] * x[next];
    } else {
      const uint side = i - count;  // 0 to 5: along an axis; then the polygon's own plane
      const float sign = side & 1 ? -1.0f : 1.0f;
      nx[i] = side >= 6 ? (float)t->normal[0] : side / 2 == 0 ? sign : 0.0f;
      ny[i] = side >= 6 ? (float)t->normal[1] : side / 2 == 1 ? sign : 0.0f;
      nz[i] = side >= 6 ? (float)t->normal[2] : side / 2 == 2 ? sign : 0.0f;
    }
  }
  Real3 n = real3(vload16(0, nx), vload16(0, ny), vload16(0, nz));
  const real size = fabs(n.x) + fabs(n.y) + fabs(n.z), inverse = size > 1e-30f ? 1.0f / size : REAL(0.0f);
  // The corners are below a plane through an edge and above their own.
  const float mean_x = dot(vload16(0, x).lo.lo, (float4)(1.0f)) + dot(vload16(0, x).lo.hi, (float4)(1.0f)),
              mean_y = dot(vload16(0, y).lo.lo, (float4)(1.0f)) + dot(vload16(0, y).lo.hi, (float4)(1.0f)),
              mean_z = dot(vload16(0, z).lo.lo, (float4)(1.0f)) + dot(vload16(0, z).lo.hi, (float4)(1.0f));
  const real side = n.x * mean_x + n.y * mean_y + n.z * mean_z;
  const mask_t of_edge = LANE_INDEX < (int16)((int)count), own = LANE_INDEX >= (int16)((int)count + 6);
  const real turned = (of_edge & (side > 0.0f)) | (own & (side < 0.0f)) ? -inverse : inverse;
  n = scale3(n, turned);
  real bound = REAL(0.0f);
  for (uint i = 0; i < count; ++i)
    bound = lane_max(bound, fma(n.x, REAL(x[i]), fma(n.y, REAL(y[i]), n.z * z[i])));
  s->bound = bound + (s->off + 0x1p-19f * (s->farthest + s->sum));
  const real none = REAL(0.0f);
  s->above = real3(lane_max(n.x, none), lane_max(n.y, none), lane_max(n.z, none));
  s->below = real3(lane_min(n.x, none), lane_min(n.y, none), lane_min(n.z, none));
}

// Whether some segment may meet the box.
static inline bool shaft_meets(const Shaft* s, float low_x, float low_y, float low_z, float high_x,
                               float high_y, float high_z) {
  const real least = fma(s->above.x, REAL(low_x - s->x),
                         fma(s->above.y, REAL(low_y - s->y),
                             fma(s->above.z, REAL(low_z - s->z),
                                 fma(s->below.x, REAL(high_x - s->x),
                                     fma(s->below.y, REAL(high_y - s->y), s->below.z * (high_z - s->z))))));
  return !any_lane(least > s->bound);
}

static inline float size_in(const Shaft* s, RayPlane p) {
  return fabs((float)p.x) * s->extent[0] + fabs((float)p.y) * s->extent[1] + fabs((float)p.z) * s->extent[2];
}

// A dot product at each corner: above 0 (1), below 0 (-1) or on both sides (0) for every point of the piece,
// as rays round it.
static int side_of_corners(const Shaft* s, RayPlane plane, double turn) {
  const float x = (float)(plane.x * turn), y = (float)(plane.y * turn), z = (float)(plane.z * turn);
  const real side = ray_side(s->corners, x, y, z, 0.0f);
  const float size = fabs(x) + fabs(y) + fabs(z);
  const float slack = 0x1p-19f * (fabs(x) * s->extent[0] + fabs(y) * s->extent[1] + fabs(z) * s->extent[2]) +
                      size * s->off + 1e-30f;
  return !any_lane(side < slack) ? 1 : !any_lane(side > -slack) ? -1 : 0;
}

// Whether all corners of a triangle lie beyond a plane of the shaft. With d from the light to a point,
// weights u, v, w of the corners a, b, c, and a plane's normal N: det (N·d) = u (N·a) + v (N·b) + w (N·c). Of
// a triangle that is met, no weight is below 0 by more than rounding, and their sum is at least det, less the
// share `short_of` of it. N·d is then at least this much.
static bool corners_beyond(const Shaft* s, const double a[3], const double b[3], const double c[3],
                           const RayPlane planes[3], float det, float short_of) {
  const Real3 n = add3(s->above, s->below);
  const real of_a = n.x * (float)a[0] + n.y * (float)a[1] + n.z * (float)a[2],
             of_b = n.x * (float)b[0] + n.y * (float)b[1] + n.z * (float)b[2],
             of_c = n.x * (float)c[0] + n.y * (float)c[1] + n.z * (float)c[2];
  float rounded = 0.0f;
  for (int i = 0; i < 3; ++i) rounded = max(rounded, size_in(s, planes[i]));
  const real least = lane_min(lane_min(of_a, of_b), of_c),
             most = lane_max(lane_max(fabs(of_a), fabs(of_b)), fabs(of_c));
  const real at_least =
      least * (1.0f - short_of) - most * (3.0f * (0x1p-19f * rounded + 1e-30f) / det + 0x1p-20f);
  return det > 0.0f && any_lane(at_least > s->bound);
}

enum ShaftHit { MISSES, MAY_HIDE, HIDES_ALL };

// As meets_from_point and ray_hides have it, for all points of the piece.
static int hit_of(const Shaft* s, global const ShadowLight* l, global const RayTriangle* t) {
  global const float* p = t->corners;
  if (!shaft_meets(s, least_of_3(p[0], p[3], p[6]), least_of_3(p[1], p[4], p[7]),
                   least_of_3(p[2], p[5], p[8]), greatest_of_3(p[0], p[3], p[6]),
                   greatest_of_3(p[1], p[4], p[7]), greatest_of_3(p[2], p[5], p[8])))
    return MISSES;
  const double nx = t->normal[0], ny = t->normal[1], nz = t->normal[2];
  const double a[3] = {p[0] - l->x, p[1] - l->y, p[2] - l->z}, b[3] = {p[3] - l->x, p[4] - l->y, p[5] - l->z},
               c[3] = {p[6] - l->x, p[7] - l->y, p[8] - l->z};
  const double distance = nx * a[0] + ny * a[1] + nz * a[2];
  if (!(distance > 0 || distance < 0)) return MISSES;
  const double turn = distance < 0 ? -1 : 1;
  if (!((nx * b[0] + ny * b[1] + nz * b[2]) * turn > 0 && (nx * c[0] + ny * c[1] + nz * c[2]) * turn > 0))
    return MISSES;
  const float px = (float)(nx * turn), py = (float)(ny * turn), pz = (float)(nz * turn),
              plane = (float)(distance * turn), size = fabs(px) + fabs(py) + fabs(pz);
  const real past = ray_side(s->corners, px, py, pz, 0.0f);
  const float slack =
      0x1p-19f * (fabs(px) * s->extent[0] + fabs(py) * s->extent[1] + fabs(pz) * s->extent[2] + plane) +
      size * s->off + 1e-30f;
  const float least = least_of(past) - slack, most = greatest_of(past) + slack;
  // Segments end a gap before their points, which is at least this much of the way across the plane.
  if (most - plane < s->gap_low * max(least, 0.0f) / s->farthest) return MISSES;
  const RaySource source = {l->x, l->y, l->z, 1};
  const RayPlane planes[3] = {edge_plane(source, true, b[0], b[1], b[2], c[0], c[1], c[2]),
                              edge_plane(source, true, c[0], c[1], c[2], a[0], a[1], a[2]),
                              edge_plane(source, true, a[0], a[1], a[2], b[0], b[1], b[2])};
  bool all =
      least - plane > s->gap_high * size && s->nearest > 2.0f * s->gap_high && !(t->number & RAY_MASKED);
  for (int i = 0; i < 3; ++i) {
    const int side = side_of_corners(s, planes[i], turn);
    if (side < 0) return MISSES;
    all = all && side > 0;
  }
  if (all) return HIDES_ALL;
  const float det = (float)((planes[0].x * a[0] + planes[0].y * a[1] + planes[0].z * a[2]) * turn);
  return corners_beyond(s, a, b, c, planes, det, slack / plane) ? MISSES : MAY_HIDE;
}

// Walks the tree for the triangles that may hide a point. Returns the certificate's kind.
static uint find_hiding(const RayScene* scene, const Shaft* s, global const ShadowLight* l, uint own,
                        int places[CERTIFICATE_PLACES], uint* found) {
  int stack[RAY_STACK], height = 0, at = 0;
  uint count = 0;
  for (;;) {
    global const RayNode* n = scene->nodes + at;
    bool go[2] = {n->count_0 >= 0 && shaft_meets(s, n->low_0[0], n->low_0[1], n->low_0[2], n->high_0[0],
                                                 n->high_0[1], n->high_0[2]),
                  n->count_1 >= 0 && shaft_meets(s, n->low_1[0], n->low_1[1], n->low_1[2], n->high_1[0],
                                                 n->high_1[1], n->high_1[2])};
    for (int child = 0; child < 2; ++child) {
      const int first = child ? n->child_1 : n->child_0, triangles = child ? n->count_1 : n->count_0;
      if (!go[child] || triangles == 0) continue;
      go[child] = false;
      for (int place = first; place < first + triangles; ++place) {
        global const RayTriangle* t = scene->triangles + place;
        if ((t->number & ~RAY_MASKED) == own) continue;
        const int hit = hit_of(s, l, t);
        if (hit == MISSES) continue;
        if (hit == HIDES_ALL) {
          *found = 0;
          return CERTIFICATE_HIDDEN;
        }
        if (count < CERTIFICATE_PLACES) places[count] = place;
        if (++count == MOST_SEEN) return CERTIFICATE_UNDECIDED;
      }
    }
    if (go[0]) {
      at = n->child_0;
      if (go[1]) stack[height++] = n->child_1;
    } else if (go[1]) {
      at = n->child_1;
    } else if (height != 0) {
      at = stack[--height];
    } else {
      break;
    }
  }
  *found = count <= CERTIFICATE_PLACES ? count : 0;
  return count == 0                    ? CERTIFICATE_FREE
         : count <= CERTIFICATE_PLACES ? CERTIFICATE_FEW
                                       : CERTIFICATE_UNDECIDED;
}

// Whether may_shade lets in every point for any view: ranges are no smaller there.
static bool all_reached(const Shaft* s, global const ShadowLight* l) {
  if (!(s->farthest <= l->range * 0.999999f)) return false;
  if (l->cos_outer <= -1.0f) return true;
  if (l->cos_outer < 0.0f) return false;
  // A concave function: least at a corner.
  const Real3 c = s->corners;
  const real inside = fma(c.x, REAL(l->axis_x), fma(c.y, REAL(l->axis_y), c.z * l->axis_z)) -
                      l->cos_outer * sqrt(fma(c.x, c.x, fma(c.y, c.y, c.z * c.z)));
  return least_of(inside) > 0x1p-18f * s->farthest + 4.0f * s->off;
}

// All but the slot's key and version.
static __attribute__((noinline)) uint make_certificate(const RayScene* scene, const Piece* piece,
                                                       global const ShadowLight* l,
                                                       int places[CERTIFICATE_PLACES]) {
  global const RayTriangle* t = scene->triangles + scene->places[piece->triangle];
  Polygon polygon;
  polygon_of(&polygon, t, piece);
  if (polygon.count < 3) return CERTIFICATE_UNDECIDED;
  Shaft shaft;
  set_shaft(&shaft, scene, t, piece, &polygon, l);
  // Only so far are casters that move noticed (passes/shadows/certificates.cpp); no product overflows.
  if (!(shaft.farthest <= CERTIFICATE_FARTHEST * l->range) || !(shaft.sum < 0x1p40f))
    return CERTIFICATE_UNDECIDED;
  uint found = 0;
  const uint kind = find_hiding(scene, &shaft, l, piece->triangle, places, &found);
  return kind | found << CERTIFICATE_COUNT_SHIFT | (all_reached(&shaft, l) ? CERTIFICATE_REACHED : 0);
}
