// What the kernels that make light cells share: the walk to the triangles in a light's reach, and the cells
// that a triangle takes part in.
//
// Lists are conservative: whatever triangle the test of rays/ray_packet.h can meet, with all its rounding, is
// in the list of the ray's cell. A ray passes that test only if
//   - float planes, the very ones stored here, have it on their positive side but for 3 roundings of a dot
//     product, less than 2^-21 of the sum of the terms' magnitudes;
//   - it meets the triangle's own box, moved outwards by less than BOX_PAD of the coordinates in play.
// Each edge's plane is tested against a cell on its own, and the box bounds the cells. A bound by the
// projected corners would be wrong: at an acute corner what rounds two planes reaches far beyond it. The
// lookup finds a ray's cell with an error of less than 2^-21 of a face's width.
#pragma once

#define LANES 16
#include "kernels/rays/rays.h"
#include "shared/light_cells.h"

#define BOX_PAD 4e-6f      // of a box's and the light's coordinates
#define PLANE_SLACK 1e-5f  // of a plane's coefficients: rounding, and where in its cell a ray is
#define CELL_SLACK 1e-3f   // of a cell: rounding of where a box begins and ends

// A box relative to a light, with room for all that a box test rounds.
typedef struct SeenBox {
  float low[3], high[3];
  float near;  // metres to its nearest point
} SeenBox;

static inline float larger(float a, float b) { return a > b ? a : b; }
static inline float smaller(float a, float b) { return a < b ? a : b; }

static inline SeenBox seen_box(global const LightCellJob* job, const float low[3], const float high[3]) {
  const double at[3] = {job->x, job->y, job->z};
  SeenBox box;
  float most = 0, size = 0, squared = 0;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = (float)(low[k] - at[k]), box.high[k] = (float)(high[k] - at[k]);
    most = larger(most, larger(fabs(box.low[k]), fabs(box.high[k]))), size += fabs((float)at[k]);
  }
  const float pad = BOX_PAD * (size + most) + 1e-12f;
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= pad, box.high[k] += pad;
    const float away = larger(larger(box.low[k], -box.high[k]), 0.0f);
    squared += away * away;
  }
  box.near = sqrt(squared) * 0.9999f;
  return box;
}

static inline SeenBox box_of_triangle(global const LightCellJob* job, global const RayTriangle* t) {
  global const float* c = t->corners;
  float low[3], high[3];
  for (int k = 0; k < 3; ++k)
    low[k] = least_of_3(c[k], c[3 + k], c[6 + k]), high[k] = greatest_of_3(c[k], c[3 + k], c[6 + k]);
  return seen_box(job, low, high);
}

// The leaves in a light's reach one after the other, roughly the nearest first.
typedef struct LeafWalk {
  int child[RAY_STACK + 2], count[RAY_STACK + 2];  // each step down leaves one behind
  int height;
} LeafWalk;

static inline void push_child(LeafWalk* walk, int child, int count) {
  walk->child[walk->height] = child, walk->count[walk->height++] = count;
}

// False: there is none left.
static inline bool next_leaf(LeafWalk* walk, global const RayNode* nodes, global const LightCellJob* job,
                             int* first, int* count) {
  while (walk->height != 0) {
    const int child = walk->child[--walk->height], triangles = walk->count[walk->height];
    if (triangles != 0) {
      *first = child, *count = triangles;
      return true;
    }
    global const RayNode* n = nodes + child;
    float low[2][3], high[2][3];
    for (int k = 0; k < 3; ++k) {
      low[0][k] = n->low_0[k], high[0][k] = n->high_0[k];
      low[1][k] = n->low_1[k], high[1][k] = n->high_1[k];
    }
    const float reach = job->reach_m;
    const float near_0 = seen_box(job, low[0], high[0]).near, near_1 = seen_box(job, low[1], high[1]).near;
    const bool go_0 = n->count_0 != RAY_NOTHING && near_0 <= reach,
               go_1 = n->count_1 != RAY_NOTHING && near_1 <= reach;
    if (go_1 && near_1 >= near_0) push_child(walk, n->child_1, n->count_1);
    if (go_0) push_child(walk, n->child_0, n->count_0);
    if (go_1 && near_1 < near_0) push_child(walk, n->child_1, n->count_1);
  }
  return false;
}

static inline void store_plane(global float* to, RayPlane plane, double turn) {
  to[0] = (float)(plane.x * turn), to[1] = (float)(plane.y * turn), to[2] = (float)(plane.z * turn);
}

// As meets_triangle of rays/ray_packet.h makes them. False: the light is in the triangle's plane, but for
// rounding, and no ray meets it.
static inline bool see_triangle(global LightCellTriangle* to, global const LightCellJob* job,
                                global const RayTriangle* t, uint place, float near) {
  const RaySource l = {job->x, job->y, job->z, 1};
  const double nx = t->normal[0], ny = t->normal[1], nz = t->normal[2];
  const double ax = t->corners[0] - l.x, ay = t->corners[1] - l.y, az = t->corners[2] - l.z;
  const double bx = t->corners[3] - l.x, by = t->corners[4] - l.y, bz = t->corners[5] - l.z;
  const double cx = t->corners[6] - l.x, cy = t->corners[7] - l.y, cz = t->corners[8] - l.z;
  const double distance = nx * ax + ny * ay + nz * az, turn = distance < 0 ? -1 : 1;
  if (!(distance * turn > 0 && (nx * bx + ny * by + nz * bz) * turn > 0 &&
        (nx * cx + ny * cy + nz * cz) * turn > 0))
    return false;
  to->normal[0] = (float)(nx * turn), to->normal[1] = (float)(ny * turn), to->normal[2] = (float)(nz * turn);
  to->offset = (float)(-distance * turn);
  store_plane(to->edge_0, edge_plane(l, true, bx, by, bz, cx, cy, cz), turn);
  store_plane(to->edge_1, edge_plane(l, true, cx, cy, cz, ax, ay, az), turn);
  store_plane(to->edge_2, edge_plane(l, true, ax, ay, az, bx, by, bz), turn);
  to->place = place, to->near = near, to->padding = 0;
  return true;
}

// One face of the cube: which coordinates are along it and across it, and the cells.
typedef struct CubeFace {
  int along, u, v;
  float sign;
  global uint* starts;
} CubeFace;

static inline CubeFace cube_face(global uint* starts, uint size, int number) {
  const int along = number / 2;
  const CubeFace face = {along, along == 0 ? 1 : 0, along == 2 ? 1 : 2, number % 2 ? -1.0f : 1.0f,
                         starts + (size_t)number * (size * size + 1)};
  return face;
}

// The greatest value that a plane has in a cell: x, y and 1 times these. h: a cell's width.
typedef struct CellPlane {
  float x, y, at;
} CellPlane;

static inline CellPlane greatest_in_cells(global const float* plane, const CubeFace* f, float h) {
  const float a = plane[f->u], b = plane[f->v], c = plane[f->along] * f->sign;
  const CellPlane p = {a * h, b * h,
                       c - a - b + (larger(a, 0.0f) + larger(b, 0.0f)) * h +
                           PLANE_SLACK * (fabs(a) + fabs(b) + fabs(c)) + 1e-37f};
  return p;
}

static inline real plane_in_cells(CellPlane p, real x, real y) {
  return fma(x, REAL(p.x), fma(y, REAL(p.y), REAL(p.at)));
}

// The cells from *first to *last that a box may be seen in along one coordinate; false: none.
static inline bool cells_of_box(float low, float high, float along_low, float along_high, float size,
                                int* first, int* last) {
  if (low > 1.01f * along_high || -high > 1.01f * along_high) return false;  // most boxes, without a division
  const float nearest = larger(along_low, 1e-30f);
  const float from = low / (low < 0.0f ? nearest : along_high),
              to = high / (high > 0.0f ? nearest : along_high);
  const float half_size = 0.5f * size;
  const float begin = fma(from, half_size, half_size) - CELL_SLACK,
              end = fma(to, half_size, half_size) + CELL_SLACK;
  if (begin >= size || end < 0.0f) return false;
  *first = (int)larger(begin, 0.0f), *last = (int)smaller(end, size - 1.0f);
  return true;
}
