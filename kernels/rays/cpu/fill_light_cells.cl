// The last step to a light's cells: their entries, the nearest first. A work-item per light.
//
// RAYS_ARGUMENTS  the scene
// jobs            LightCellJob
// seen            LightCellTriangle, from the job's first_triangle on
// starts          in: of a cell, where its entries begin among those of the light; out: among all
// entries         out: LightCellEntry, from the job's first_entry on
#include "kernels/rays/cpu/light_cell_lists.h"

// Triangles came roughly in this order, so that few entries move far.
static inline void sort_entries(global LightCellEntry* entries, uint first, uint end) {
  for (uint i = first + 1; i < end; ++i) {
    const LightCellEntry entry = entries[i];
    uint to = i;
    for (; to > first && entries[to - 1].near > entry.near; --to) entries[to] = entries[to - 1];
    entries[to] = entry;
  }
}

kernel void fill_light_cells(RAYS_ARGUMENTS, global const LightCellJob* jobs,
                             global const LightCellTriangle* seen, global uint* starts,
                             global LightCellEntry* entries) {
  global const LightCellJob* job = jobs + get_global_id(0);
  starts += job->first_start, seen += job->first_triangle;
  const uint all = 6 * (job->size * job->size + 1);
  for (uint i = 0; i < all; ++i) starts[i] += job->first_entry;
  for (uint i = 0; i < job->triangles; ++i) {
    const SeenBox box = box_of_triangle(job, ray_triangles + seen[i].place);
    add_to_cells(job, starts, &box, seen + i, job->first_triangle + i, entries);
  }
  // Where a cell's entries began, the next one's begin now; a face's first cell begins at its own 0.
  for (uint i = 0; i + 1 < all; ++i) {
    if (starts[i + 1] > starts[i]) sort_entries(entries, starts[i], starts[i + 1]);
  }
}
