// The first step to a light's cells: how many triangles the leaves in its reach have. A work-item per light.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob
#include "kernels/rays/cpu/light_cell_builder.h"

kernel void gather_light_cells(RAYS_ARGUMENTS, global LightCellJob* jobs) {
  global LightCellJob* job = jobs + get_global_id(0);
  LeafWalk walk = {{0}, {0}, 1};
  int first, count;
  uint gathered = 0;
  while (next_leaf(&walk, ray_nodes, job, &first, &count)) gathered += (uint)count;
  job->gathered = gathered;
}
