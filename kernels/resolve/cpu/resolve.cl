// Radiance of every pixel of a visibility buffer, for CPUs: a work-item takes a tile, block after block of 4
// x 4 pixels (kernels/resolve/resolve_block.h), then the tile's lights. Burns, Hunt, "The Visibility Buffer"
// (JCGT 2013).
//
// triangles, depths  a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h
// background  of pixels without a surface
// image       out: RGBA a pixel, linear, row 0 at the bottom
// -DTILE      pixels a side, a multiple of 8 (default 16)
// -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_light.h"

kernel void resolve(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                    float4 background, global float* image) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, tile_y * view->tiles_x + tile_x, view);
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      Real3 color = real3(REAL(background.x), REAL(background.y), REAL(background.z));
      if (any_lane(covered)) {
        const Attributes* a = block_attributes(&walk, covered, x, y);
        Surface s = {0};
        add_materials(&s, a, &scene, covered);
        const real depth = block_depths(&walk, depths, x, y);
        light_pixels(&lights.lights, x, y, view);
        const Real3 shown = radiance(a, &s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth,
                                     covered, &lights, bin_edges, view);
        color = real3(covered ? shown.x : color.x, covered ? shown.y : color.y, covered ? shown.z : color.z);
      }
      store_block(image, color, REAL(1.0f), x, y, width, height);
    }
  }
}
