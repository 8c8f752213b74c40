// The normal of every pixel of a visibility buffer, for the light buffer of light_prepass, for CPUs: a
// work-item takes a tile, block after block of 4 x 4 pixels.
//
// triangles   a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; no lights are read
// normals     out: a pixel each (shared/stored_normal.h)
// -DTILE      pixels a side, a multiple of 8 (default 16)
// -DNORMALS_…, and what kernels/resolve/resolve.h names
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_normals.h"

kernel void resolve_normals(global const uint* triangles, RESOLVE_ARGUMENTS,
                            global normal_t* normals GROUP_NUMBERS_OUT) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      const Attributes* a = block_attributes(&walk, covered, x, y);
      Surface s = {0};
      add_materials(&s, a, &scene, covered);
      const Real3 n = shading_normal(a, &s);
      const TexelPlaces places = texels_of_block(x, y, width, height);
      store_normals(normals, n, covered, &places);
#ifdef GROUP_NUMBERS
      store_group_numbers(group_numbers, a->group_number, covered, &places);
#endif
    }
  }
}
