// The first step to a light's cells: counts the triangles of the leaves in its reach and, for a directional
// light, finds the box of all triangles. One work-item per light.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob
#include "kernels/rays/cpu/light_cell_builder.h"

static void add_to_box(global LightCellJob* job, global const float* low, global const float* high) {
  for (int k = 0; k < 3; ++k)
    job->low[k] = smaller(job->low[k], low[k]), job->high[k] = larger(job->high[k], high[k]);
}

kernel void gather_light_cells(RAYS_ARGUMENTS, global LightCellJob* jobs) {
  global LightCellJob* job = jobs + get_global_id(0);
  LeafWalk walk = {{0}, {0}, 1};
  int first, count;
  uint gathered = 0;
  while (next_leaf(&walk, ray_nodes, job, &first, &count)) gathered += (uint)count;
  job->gathered = gathered;
  if (job->w != 0) return;
  if (ray_nodes->count_0 != RAY_NOTHING) add_to_box(job, ray_nodes->low_0, ray_nodes->high_0);
  if (ray_nodes->count_1 != RAY_NOTHING) add_to_box(job, ray_nodes->low_1, ray_nodes->high_1);
}
