// 16 triangles as a light sees them: their planes, as meets_triangle of rays/ray_packet.h makes them for a
// light at a point, with the same bits, and their boxes.
#pragma once

#include "kernels/rays/cpu/light_cell_builder.h"

typedef struct SeenTriangles {
  real normal[3], offset, edges[3][3];
  real low[3], high[3];  // as those of SeenBox
  real near;
  whole place;
} SeenTriangles;

#define ALIGNED __attribute__((aligned(128)))  // arrays that are read as vectors
typedef double16 Wide;
#define WIDE(x) __builtin_convertvector(x, Wide)
#define NARROW(x) __builtin_convertvector(x, real)
#define WIDE_MASK(x) __builtin_convertvector(x, mask_t)

static inline Wide wide_dot(const Wide a[3], const Wide b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// The plane through the light and two corners: edge_plane of rays/ray_packet.h.
static inline void wide_edge(real to[3], const Wide b[3], const Wide c[3], Wide turn) {
  to[0] = NARROW((b[1] * c[2] - b[2] * c[1]) * turn);
  to[1] = NARROW((b[2] * c[0] - b[0] * c[2]) * turn);
  to[2] = NARROW((b[0] * c[1] - b[1] * c[0]) * turn);
}

static inline void see_boxes(SeenTriangles* s, global const LightCellJob* job, const Wide c[3][3]) {
  const float size = fabs((float)job->x) + fabs((float)job->y) + fabs((float)job->z);
  real most = REAL(0.0f), squared = REAL(0.0f);
  for (int k = 0; k < 3; ++k) {
    const real x = NARROW(c[0][k]), y = NARROW(c[1][k]), z = NARROW(c[2][k]);
    s->low[k] = lane_min(lane_min(x, y), z), s->high[k] = lane_max(lane_max(x, y), z);
    most = lane_max(most, lane_max(fabs(s->low[k]), fabs(s->high[k])));
  }
  const real pad = BOX_PAD * (size + most) + 1e-12f;
  for (int k = 0; k < 3; ++k) {
    s->low[k] -= pad, s->high[k] += pad;
    const real away = lane_max(lane_max(s->low[k], -s->high[k]), REAL(0.0f));
    squared = fma(away, away, squared);
  }
  s->near = sqrt(squared) * 0.9999f;
}

// Of the triangles at these places, those in the light's reach, but for those in whose plane it is, but for
// rounding: no ray meets them.
static inline uint see_triangles(SeenTriangles* s, global const LightCellJob* job,
                                 global const RayTriangle* triangles, const int* places, uint count) {
  float corners[9][LANES] ALIGNED;
  double normals[3][LANES] ALIGNED;
  for (uint lane = 0; lane < LANES; ++lane) {
    global const RayTriangle* t = triangles + places[lane < count ? lane : 0];
    for (int k = 0; k < 9; ++k) corners[k][lane] = t->corners[k];
    for (int k = 0; k < 3; ++k) normals[k][lane] = t->normal[k];
  }
  const double at[3] = {job->x, job->y, job->z};
  Wide c[3][3], n[3];
  for (int k = 0; k < 3; ++k) {
    n[k] = *(const Wide*)normals[k];
    for (int corner = 0; corner < 3; ++corner) c[corner][k] = WIDE(*(const real*)corners[3 * corner + k]) - at[k];
  }
  const Wide distance = wide_dot(n, c[0]);
  const Wide turn = distance < 0.0 ? (Wide)(-1.0) : (Wide)(1.0);
  const mask_t faces = WIDE_MASK(distance * turn > 0.0) & WIDE_MASK(wide_dot(n, c[1]) * turn > 0.0) &
                       WIDE_MASK(wide_dot(n, c[2]) * turn > 0.0);
  see_boxes(s, job, c);
  for (int k = 0; k < 3; ++k) s->normal[k] = NARROW(n[k] * turn);
  s->offset = NARROW(-distance * turn);
  wide_edge(s->edges[0], c[1], c[2], turn);
  wide_edge(s->edges[1], c[2], c[0], turn);
  wide_edge(s->edges[2], c[0], c[1], turn);
  s->place = *(const whole*)places;
  return mask_bits(faces & (s->near <= job->reach_m)) & first_lanes(count);
}

// Those of the lanes `left`, one after the other.
static inline void store_triangles(global LightCellTriangle* to, const SeenTriangles* s, uint left) {
  for (; left != 0; left &= left - 1, ++to) {
    const uint lane = lowest_bit(left);
#define OF_LANE(x) (((const float*)&(x))[lane])
    for (int k = 0; k < 3; ++k) {
      to->normal[k] = OF_LANE(s->normal[k]), to->edge_0[k] = OF_LANE(s->edges[0][k]);
      to->edge_1[k] = OF_LANE(s->edges[1][k]), to->edge_2[k] = OF_LANE(s->edges[2][k]);
    }
    to->offset = OF_LANE(s->offset), to->near = OF_LANE(s->near);
    to->place = ((const uint*)&s->place)[lane], to->padding = 0;
  }
}
