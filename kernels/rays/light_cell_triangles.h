// LANES triangles as a light sees them: their boxes, and their planes with the bits that meets_triangle of
// rays/ray_packet.h computes.
#pragma once

#include "kernels/rays/light_cell_builder.h"

typedef struct SeenTriangles {
  real normal[3], offset, edges[3][3];
  real edge_offsets[3];  // for a directional light
  real low[3], high[3];  // for a point light as those of SeenBox, else of the corners
  real near;             // for a point light
  whole place;
} SeenTriangles;

#define ALIGNED __attribute__((aligned(128)))  // arrays that are read as vectors
#if LANES == 1
typedef double Wide;
#define WIDE(x) ((double)(x))
#define NARROW(x) ((float)(x))
#define WIDE_MASK(x) (x)
#define first_lanes(n) 1u
#else
typedef double16 Wide;
#define WIDE(x) __builtin_convertvector(x, Wide)
#define NARROW(x) __builtin_convertvector(x, real)
#define WIDE_MASK(x) __builtin_convertvector(x, mask_t)
#endif

static inline Wide wide_dot(const Wide a[3], const Wide b[3]) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

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
    s->low[k] = lane_min(lane_min(x, y), z);
    s->high[k] = lane_max(lane_max(x, y), z);
    most = lane_max(most, lane_max(fabs(s->low[k]), fabs(s->high[k])));
  }
  const real pad = BOX_PAD * (size + most) + 1e-12f;
  for (int k = 0; k < 3; ++k) {
    s->low[k] -= pad;
    s->high[k] += pad;
    const real away = lane_max(lane_max(s->low[k], -s->high[k]), REAL(0.0f));
    squared = fma(away, away, squared);
  }
  s->near = sqrt(squared) * 0.9999f;
  if (job->grid.top < -1.0f) return;
  real center[3], radius = REAL(0.0f);
  for (int k = 0; k < 3; ++k) {
    const real half_size = 0.5f * (s->high[k] - s->low[k]);
    center[k] = 0.5f * (s->low[k] + s->high[k]);
    radius = fma(half_size, half_size, radius);
  }
  s->near = misses_cone(job, center, sqrt(radius) * 1.001f) ? REAL(INFINITY) : s->near;
}

// The plane through two corners along the light's direction.
static inline void wide_edge_along(real to[3], real* offset, const Wide b[3], const Wide c[3],
                                   const double d[3], Wide turn) {
  const Wide u[3] = {b[0] - c[0], b[1] - c[1], b[2] - c[2]};
  const Wide x = d[1] * u[2] - d[2] * u[1], y = d[2] * u[0] - d[0] * u[2], z = d[0] * u[1] - d[1] * u[0];
  to[0] = NARROW(x * turn);
  to[1] = NARROW(y * turn);
  to[2] = NARROW(z * turn);
  *offset = NARROW(-0.5 * (x * (b[0] + c[0]) + y * (b[1] + c[1]) + z * (b[2] + c[2])) * turn);
}

// The triangles at these places: normals, and corners relative to `at`.
static inline void read_triangles(SeenTriangles* s, Wide n[3], Wide c[3][3],
                                  global const RayTriangle* triangles, const double at[3], const int* places,
                                  uint count) {
  float corners[9][LANES] ALIGNED;
  double normals[3][LANES] ALIGNED;
  for (uint lane = 0; lane < LANES; ++lane) {
    global const RayTriangle* t = triangles + places[lane < count ? lane : 0];
    for (int k = 0; k < 9; ++k) corners[k][lane] = t->corners[k];
    for (int k = 0; k < 3; ++k) normals[k][lane] = t->normal[k];
  }
  for (int k = 0; k < 3; ++k) {
    n[k] = *(const Wide*)normals[k];
    for (int corner = 0; corner < 3; ++corner)
      c[corner][k] = WIDE(*(const real*)corners[3 * corner + k]) - at[k];
  }
  s->place = *(const whole*)places;
}

// Reads triangles for a directional light. Returns a mask of the lanes but for those of triangles whose
// plane is parallel to it.
static inline uint see_along(SeenTriangles* s, global const LightCellJob* job,
                             global const RayTriangle* triangles, const int* places, uint count) {
  const double d[3] = {job->x, job->y, job->z}, origin[3] = {0, 0, 0};
  Wide c[3][3], n[3];
  read_triangles(s, n, c, triangles, origin, places, count);
  const Wide facing = -(n[0] * d[0] + n[1] * d[1] + n[2] * d[2]);
  const Wide turn = facing < 0.0 ? (Wide)(-1.0) : (Wide)(1.0);
  for (int k = 0; k < 3; ++k) {
    const real x = NARROW(c[0][k]), y = NARROW(c[1][k]), z = NARROW(c[2][k]);
    s->low[k] = lane_min(lane_min(x, y), z);
    s->high[k] = lane_max(lane_max(x, y), z);
    s->normal[k] = NARROW(n[k] * turn);
  }
  s->offset = NARROW(-wide_dot(n, c[0]) * turn);
  wide_edge_along(s->edges[0], &s->edge_offsets[0], c[1], c[2], d, turn);
  wide_edge_along(s->edges[1], &s->edge_offsets[1], c[2], c[0], d, turn);
  wide_edge_along(s->edges[2], &s->edge_offsets[2], c[0], c[1], d, turn);
  return lane_bits(WIDE_MASK(facing * turn > 0.0)) & first_lanes(count);
}

// Reads triangles for a point light. Returns a mask of the lanes of triangles in its reach. Triangles in
// whose plane it lies, within rounding, are left out: no ray meets them.
static inline uint see_from_point(SeenTriangles* s, global const LightCellJob* job,
                                  global const RayTriangle* triangles, const int* places, uint count) {
  const double at[3] = {job->x, job->y, job->z};
  Wide c[3][3], n[3];
  read_triangles(s, n, c, triangles, at, places, count);
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
  for (int k = 0; k < 3; ++k) s->edge_offsets[k] = REAL(0.0f);
  return lane_bits(faces & (s->near <= job->reach_m)) & first_lanes(count);
}

static inline void store_triangle(global LightCellTriangle* to, const SeenTriangles* s, uint lane,
                                  bool point) {
#define OF_LANE(x) (((const float*)&(x))[lane])
  for (int k = 0; k < 3; ++k) {
    to->normal[k] = OF_LANE(s->normal[k]);
    to->edge_0[k] = OF_LANE(s->edges[0][k]);
    to->edge_1[k] = OF_LANE(s->edges[1][k]);
    to->edge_2[k] = OF_LANE(s->edges[2][k]);
  }
  to->normal[3] = OF_LANE(s->offset);
  to->edge_0[3] = point ? as_float(((const int*)&s->place)[lane]) : OF_LANE(s->edge_offsets[0]);
  to->edge_1[3] = OF_LANE(s->edge_offsets[1]);
  to->edge_2[3] = OF_LANE(s->edge_offsets[2]);
}

// Stores the triangles of the lanes `left`: for a point light one after the other from *used on, else each at
// its place. Returns their numbers.
static inline whole store_triangles(global LightCellTriangle* to, const SeenTriangles* s, uint left,
                                    bool point, uint* used) {
  if (!point) {
    for (; left != 0; left &= left - 1, ++*used)
      store_triangle(to + ((const int*)&s->place)[lowest_bit(left)], s, lowest_bit(left), false);
    return s->place;
  }
  int numbers[LANES] ALIGNED = {0};
  for (; left != 0; left &= left - 1, ++*used) {
    numbers[lowest_bit(left)] = (int)*used;
    store_triangle(to + *used, s, lowest_bit(left), true);
  }
  return *(const whole*)numbers;
}
