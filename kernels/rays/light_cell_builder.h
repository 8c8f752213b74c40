// Shared by the kernels that make light cells: the walk to the triangles in a light's reach. For 16 lanes on
// CPUs and one on GPUs.
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

#include "kernels/rays/rays.h"
#include "shared/light_cells.h"

#define BOX_PAD 4e-6f      // of a box's and the light's coordinates
#define PLANE_SLACK 1e-5f  // of a plane's coefficients: rounding, and where in its cell a ray is
#define CONE_SLACK 1e-4f   // of the cosine of a spot's cone
#define CELL_SLACK 1e-3f   // of a cell: rounding of where a box begins and ends

// A box relative to a light, with room for all that a box test rounds.
typedef struct SeenBox {
  float low[3], high[3];
  float near;  // metres to its nearest point; infinite outside of a spot's cone
} SeenBox;

static inline float larger(float a, float b) { return a > b ? a : b; }
static inline float smaller(float a, float b) { return a < b ? a : b; }

// Returns whether balls lie outside of a spot's cone, with room for rounding.
static inline mask_t misses_cone(global const LightCellJob* job, const real at[3], real radius) {
  const float cosine = job->grid.top - CONE_SLACK, sine = sqrt(fmax(1.0f - cosine * cosine, 0.0f));
  global const float* axis = job->grid.toward;
  const real along = fma(at[2], REAL(axis[2]), fma(at[1], REAL(axis[1]), at[0] * axis[0])),
             squared = fma(at[2], at[2], fma(at[1], at[1], at[0] * at[0]));
  const real aside = sqrt(lane_max(squared - along * along, REAL(0.0f)));
  return aside * cosine - along * sine > radius + 1e-3f * sqrt(squared);
}

static inline SeenBox seen_box(global const LightCellJob* job, const float low[3], const float high[3]) {
  const double at[3] = {job->x, job->y, job->z};
  SeenBox box;
  float most = 0, size = 0, squared = 0;
  for (int k = 0; k < 3; ++k) {
    box.low[k] = (float)(low[k] - at[k]);
    box.high[k] = (float)(high[k] - at[k]);
    most = larger(most, larger(fabs(box.low[k]), fabs(box.high[k])));
    size += fabs((float)at[k]);
  }
  const float pad = BOX_PAD * (size + most) + 1e-12f;
  for (int k = 0; k < 3; ++k) {
    box.low[k] -= pad;
    box.high[k] += pad;
    const float away = larger(larger(box.low[k], -box.high[k]), 0.0f);
    squared += away * away;
  }
  box.near = sqrt(squared) * 0.9999f;
  if (job->w != 0 && job->grid.top >= -1.0f) {
    real center[3];
    squared = 0;
    for (int k = 0; k < 3; ++k) {
      const float half_size = 0.5f * (box.high[k] - box.low[k]);
      center[k] = REAL(0.5f * (box.low[k] + box.high[k]));
      squared += half_size * half_size;
    }
    if (any_lane(misses_cone(job, center, REAL(sqrt(squared) * 1.001f)))) box.near = INFINITY;
  }
  return box;
}

static inline void add_to_box(global LightCellJob* job, global const float* low, global const float* high) {
  for (int k = 0; k < 3; ++k) {
    job->low[k] = smaller(job->low[k], low[k]);
    job->high[k] = larger(job->high[k], high[k]);
  }
}

// Into the job the box of all triangles.
static inline void bound_triangles(global LightCellJob* job, global const RayNode* root) {
  if (root->count_0 != RAY_NOTHING) add_to_box(job, root->low_0, root->high_0);
  if (root->count_1 != RAY_NOTHING) add_to_box(job, root->low_1, root->high_1);
}

// The leaves in a light's reach one after the other, roughly the nearest first.
typedef struct LeafWalk {
  int child[RAY_STACK + 2], count[RAY_STACK + 2];  // each step down leaves one behind
  int height;
} LeafWalk;

static inline void push_child(LeafWalk* walk, int child, int count) {
  walk->child[walk->height] = child;
  walk->count[walk->height++] = count;
}

// False: there is none left.
static inline bool next_leaf(LeafWalk* walk, global const RayNode* nodes, global const LightCellJob* job,
                             int* first, int* count) {
  while (walk->height != 0) {
    const int child = walk->child[--walk->height], triangles = walk->count[walk->height];
    if (triangles != 0) {
      *first = child;
      *count = triangles;
      return true;
    }
    global const RayNode* n = nodes + child;
    float low[2][3], high[2][3];
    for (int k = 0; k < 3; ++k) {
      low[0][k] = n->low_0[k];
      high[0][k] = n->high_0[k];
      low[1][k] = n->low_1[k];
      high[1][k] = n->high_1[k];
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
