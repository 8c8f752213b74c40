// As kernels/rays/cpu/gather_light_cells.cl, for GPUs: counts the triangles themselves. job->gathered is 0
// before.
#include "kernels/rays/gpu/light_cell_group.h"

LIGHT_CELL_KERNEL(gather_light_cells)(RAYS_ARGUMENTS, global LightCellJob* jobs) {
  global LightCellJob* job = JOB;
  if (job->w == 0) {
    if (get_global_id(0) == 0) bound_triangles(job, ray_nodes);
    return;
  }
  uint seen = 0;
  SeenTriangles s;
  FOR_ITEMS(i, triangles_of_tree(ray_nodes)) seen += see_triangle(&s, job, ray_triangles, (int)i) ? 1 : 0;
  if (seen != 0) atomic_add((volatile global uint*)&job->gathered, seen);
}
