// The second step to a light's cells: its triangles, and how many of them each cell has. A work-item per
// light.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob
// seen            out: LightCellTriangle, from the job's first_triangle on
// starts          out: of a cell, where its entries begin among those of the light
#include "kernels/rays/cpu/light_cell_lists.h"

kernel void count_light_cells(RAYS_ARGUMENTS, global LightCellJob* jobs, global LightCellTriangle* seen,
                              global uint* starts) {
  global LightCellJob* job = jobs + get_global_id(0);
  starts += job->first_start, seen += job->first_triangle;
  const uint all = 6 * (job->size * job->size + 1);
  for (uint i = 0; i < all; ++i) starts[i] = 0;
  LeafWalk walk = {{0}, {0}, 1};
  int first, count;
  uint used = 0;
  while (next_leaf(&walk, ray_nodes, job, &first, &count)) {
    for (int place = first; place < first + count; ++place) {
      const SeenBox box = box_of_triangle(job, ray_triangles + place);
      if (box.near > job->reach_m ||
          !see_triangle(seen + used, job, ray_triangles + place, (uint)place, box.near))
        continue;
      add_to_cells(job, starts, &box, seen + used, used, 0);
      ++used;
    }
  }
  uint sum = 0;
  for (uint i = 0; i < all; ++i) {
    const uint here = starts[i];
    starts[i] = sum, sum += here;
  }
  job->triangles = used, job->entries = sum;
}
