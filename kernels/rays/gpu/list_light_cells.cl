// The third step to light cells on GPUs: counts the entries of each cell. The fifth: writes them, in any
// order.
//
// RAYS_ARGUMENTS  the scene
// jobs            LightCellJob
// pool            in: LightCellTriangle; in and out: starts; out: LightCellEntry
// fill            0: entries are counted
#include "kernels/rays/gpu/light_cell_group.h"

LIGHT_CELL_KERNEL(list_light_cells)(RAYS_ARGUMENTS, global LightCellJob* jobs, global uint* pool, uint fill) {
  global const LightCellJob* job = JOB;
  const bool point = job->w != 0;
  global const LightCellTriangle* stored = (global const LightCellTriangle*)pool + job->first_triangle;
  LightCellItems items = {pool + job->first_start, fill != 0 ? (global ulong*)pool : 0, job->first_triangle};
  if (fill != 0 && !entries_fit(job)) return;
  SeenTriangles s;
  FOR_ITEMS(i, point ? job->triangles : triangles_of_tree(ray_nodes)) {
    if (!see_triangle(&s, job, ray_triangles, point ? as_int(stored[i].edge_0[3]) : (int)i)) continue;
    if (!point) add_to_grid(job, &s, 1, (int)i, &items);
    for (int f = 0; point && f < 6; ++f) {
      const CellFace face = cube_face(job, f);
      add_to_face(&face, &s, 1, (int)i, &items);
    }
  }
}
