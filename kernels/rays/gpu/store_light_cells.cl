// The second step to light cells on GPUs: stores each light's triangles. Cells have no entries yet.
//
// RAYS_ARGUMENTS  the scene
// jobs            in and out: LightCellJob; job->triangles is 0 before
// pool            out: LightCellTriangle and starts where the jobs say
#include "kernels/rays/gpu/light_cell_group.h"

LIGHT_CELL_KERNEL(store_light_cells)(RAYS_ARGUMENTS, global LightCellJob* jobs, global uint* pool) {
  global LightCellJob* job = JOB;
  const bool point = job->w != 0;
  global LightCellTriangle* to = (global LightCellTriangle*)pool + job->first_triangle;
  SeenTriangles s;
  FOR_ITEMS(i, starts_of_job(job)) pool[job->first_start + i] = 0;
  FOR_ITEMS(i, triangles_of_tree(ray_nodes)) {
    if (!see_triangle(&s, job, ray_triangles, (int)i)) continue;
    store_triangle(to + (point ? atomic_inc((volatile global uint*)&job->triangles) : i), &s, 0, point);
  }
  if (!point && get_global_id(0) == 0) job->triangles = job->gathered;
}
