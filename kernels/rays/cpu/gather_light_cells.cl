// The first step to a light's cells: counts the triangles of the leaves in its reach and, for a directional
// light, finds the box of all triangles. One work-item per light.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/rays/light_cell_builder.h"

kernel ONE_ITEM void gather_light_cells(RAYS_ARGUMENTS, global LightCellJob* jobs) {
  ASSUME_ONE_ITEM;
  global LightCellJob* job = jobs + get_global_id(0);
  LeafWalk walk = {{0}, {0}, 1};
  int first, count;
  uint gathered = 0;
  while (next_leaf(&walk, ray_nodes, job, &first, &count)) gathered += (uint)count;
  job->gathered = gathered;
  if (job->w == 0) bound_triangles(job, ray_nodes);
}
