// Shared by the kernels that make light cells on GPUs. Work-groups with the same second number share a
// light, and its triangles or cells are divided among their items.
#pragma once

#define GROUP 256
#include "kernels/rays/light_cell_lists.h"

#define LIGHT_CELL_KERNEL(name) kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void name
#define JOB (jobs + get_group_id(1))
#define FOR_ITEMS(i, count) \
  for (uint i = (uint)get_global_id(0), last_##i = (count); i < last_##i; i += (uint)get_global_size(0))

// The number of triangles in the tree, which are the first of the scene's: where its last leaf ends.
static inline uint triangles_of_tree(global const RayNode* nodes) {
  int at = 0;
  for (;;) {
    global const RayNode* n = nodes + at;
    const bool last = n->count_1 != RAY_NOTHING;
    const int child = last ? n->child_1 : n->child_0, count = last ? n->count_1 : n->count_0;
    if (count == RAY_NOTHING) return 0;
    if (count != 0) return (uint)(child + count);
    at = child;
  }
}

// Reads the triangle at a place. Returns whether rays of the light may meet it.
static inline bool see_triangle(SeenTriangles* s, global const LightCellJob* job,
                                global const RayTriangle* triangles, int place) {
  return job->w != 0 ? see_from_point(s, job, triangles, &place, 1) != 0
                     : see_along(s, job, triangles, &place, 1) != 0;
}

// The starts of a light's cells.
static inline uint starts_of_job(global const LightCellJob* job) {
  return (job->w != 0 ? 6 : 1) * (job->size * job->size + 1);
}

static inline bool entries_fit(global const LightCellJob* job) {
  return job->entries + 16 <= job->entry_room;
}
