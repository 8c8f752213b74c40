// Corners and normals of the triangles of instances that moved: the bytes that src/engine/rays/ray_arrays.cpp makes
// of them.
//
// moved      RayMoved an instance
// runs       uint2 a work-group of 64: number in `moved`, first triangle of its mesh
// positions  x y z a vertex, of all meshes
// indices    of all meshes, each into its own vertices
// places     a triangle's number to its place in `triangles`
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
#include "shared/ray_records.h"

static inline double3 placed(global const RayMoved* m, global const float* v) {
  const double x = v[0], y = v[1], z = v[2];
  return (double3)(m->x[0] * x + m->y[0] * y + m->z[0] * z + m->at[0],
                   m->x[1] * x + m->y[1] * y + m->z[1] * z + m->at[1],
                   m->x[2] * x + m->y[2] * y + m->z[2] * z + m->at[2]);
}

static inline double magnitude(double x) { return x < 0 ? -x : x; }

kernel __attribute__((reqd_work_group_size(64, 1, 1))) void refit_triangles(
    global const RayMoved* moved, global const uint2* runs, global const float* positions,
    global const uint* indices, global const uint* places, global RayTriangle* triangles) {
  const uint2 run = runs[get_group_id(0)];
  global const RayMoved* m = moved + run.x;
  const uint number = run.y + (uint)get_local_id(0);
  if (number >= m->triangles) return;
  global const uint* at = indices + m->first_index + 3 * (size_t)number;
  global RayTriangle* t = triangles + places[m->first_triangle + number];
  double corners[9];
  for (int i = 0; i < 3; ++i) {
    const double3 p = placed(m, positions + 3 * (size_t)(m->first_vertex + at[i]));
    corners[3 * i] = t->corners[3 * i] = (float)p.x;
    corners[3 * i + 1] = t->corners[3 * i + 1] = (float)p.y;
    corners[3 * i + 2] = t->corners[3 * i + 2] = (float)p.z;
  }
  const double ux = corners[3] - corners[0], uy = corners[4] - corners[1], uz = corners[5] - corners[2];
  const double vx = corners[6] - corners[0], vy = corners[7] - corners[1], vz = corners[8] - corners[2];
  const double nx = uy * vz - vy * uz, ny = uz * vx - vz * ux, nz = ux * vy - vx * uy;
  const double ax = magnitude(nx), ay = magnitude(ny), az = magnitude(nz);
  double greatest = ax < ay ? ay : ax;
  greatest = greatest < az ? az : greatest;
  t->normal[0] = greatest > 0 ? nx / greatest : 0;
  t->normal[1] = greatest > 0 ? ny / greatest : 0;
  t->normal[2] = greatest > 0 ? nz / greatest : 0;
}
