// The second step to light cells: stores each light's triangles and, for each cell, lists them, the nearest
// first. Each work-item takes light after light.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob
// next_job        in: 0
// scratch         each work-item's room for the entries of one light
// pool            out: starts, LightCellTriangle and LightCellEntry where the jobs say
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/rays/light_cell_lists.h"

// Adds up to 16 triangles.
static void add_triangles(global const LightCellJob* job, global const RayTriangle* triangles,
                          const int* places, uint count, global LightCellTriangle* to, uint* used,
                          LightCellItems* items) {
  SeenTriangles s;
  const bool point = job->w != 0;
  const uint seen = point ? see_from_point(&s, job, triangles, places, count)
                          : see_along(&s, job, triangles, places, count);
  if (seen == 0) return;
  const whole numbers = store_triangles(to, &s, seen, point, used);
  if (!point) {
    add_to_grid(job, &s, lanes_of(seen), numbers, items);
    return;
  }
  for (int i = 0; i < 6; ++i) {
    const CellFace face = cube_face(job, i);
    add_to_face(&face, &s, lanes_of(seen), numbers, items);
  }
}

static uint add_all(global const LightCellJob* job, global const RayNode* nodes,
                    global const RayTriangle* triangles, global LightCellTriangle* to,
                    LightCellItems* items) {
  LeafWalk walk = {{0}, {0}, 1};
  int places[LANES] ALIGNED;
  int first, count;
  uint used = 0, waiting = 0;
  while (next_leaf(&walk, nodes, job, &first, &count)) {
    for (int place = first; place < first + count; ++place) {
      places[waiting++] = place;
      if (waiting == LANES) {
        add_triangles(job, triangles, places, LANES, to, &used, items);
        waiting = 0;
      }
    }
  }
  if (waiting != 0) add_triangles(job, triangles, places, waiting, to, &used, items);
  return used;
}

// Replaces each value's count by the place where its items begin.
static inline void sum_counts(uint* counts, uint values) {
  uint sum = 0;
  for (uint i = 0; i < values; ++i) {
    const uint here = counts[i];
    counts[i] = sum;
    sum += here;
  }
}

// Sorted by distance, then by cell: the second step keeps the order of the first.
static void sort_items(global LightCellJob* job, const LightCellItems* items, global ulong* by_distance,
                       global uint* starts, global LightCellEntry* entries) {
  uint steps[NEAR_STEPS] = {0};
  const uint all = (job->w != 0 ? 6 : 1) * (job->size * job->size + 1);
  for (uint i = 0; i < all; ++i) starts[i] = 0;
  for (uint i = 0; i < items->count; ++i) {
    ++steps[items->keys[i] % NEAR_STEPS];
    ++starts[1 + items->keys[i] / NEAR_STEPS];
  }
  sum_counts(steps, NEAR_STEPS);
  uint sum = job->first_entry;
  float squares = 0;
  for (uint i = 0; i < all; ++i) {
    const uint here = starts[i];
    starts[i] = sum;
    sum += here;
    squares += (float)here * (float)here;
  }
  job->list_length = squares / (float)max(items->count, 1u);
  for (uint i = 0; i < items->count; ++i)
    by_distance[steps[items->keys[i] % NEAR_STEPS]++] = (ulong)items->keys[i] << 32 | items->numbers[i];
  // Placing a cell's entries moves its start to where the next cell begins. Each face has one start more than
  // cells; it counts no entries and stays where the first cell begins.
  for (uint i = 0; i < items->count; ++i) {
    const uint key = (uint)(by_distance[i] >> 32);
    const LightCellEntry entry = {job->first_triangle + (uint)by_distance[i],
                                  metres_of_steps(key % NEAR_STEPS)};
    entries[starts[1 + key / NEAR_STEPS]++] = entry;
  }
}

kernel ONE_ITEM void list_light_cells(RAYS_ARGUMENTS, global LightCellJob* jobs, uint job_count,
                                      volatile global uint* next_job, global ulong* scratch,
                                      ulong scratch_items, global uint* pool) {
  ASSUME_ONE_ITEM;
  global ulong* by_distance = scratch + get_global_id(0) * scratch_items;
  for (uint i = atomic_inc(next_job); i < job_count; i = atomic_inc(next_job)) {
    global LightCellJob* job = jobs + i;
    global LightCellEntry* entries = (global LightCellEntry*)pool;
    LightCellItems items;
    items.keys = (global uint*)(entries + job->first_entry);
    items.numbers = items.keys + job->entry_room;
    items.count = 0;
    items.room = job->entry_room;
    const uint used =
        add_all(job, ray_nodes, ray_triangles, (global LightCellTriangle*)pool + job->first_triangle, &items);
    job->triangles = job->w != 0 ? used : job->gathered;
    job->entries = items.count;
    if (items.count + LANES > items.room) continue;
    sort_items(job, &items, by_distance, pool + job->first_start, entries);
  }
}
