// The surface of every pixel of a visibility buffer into a geometry buffer, for CPUs: a work-item takes a
// tile, block after block of 4 x 4 pixels. As resolve/cpu/resolve.cl up to the surfaces; lights come from
// shade_tiles.
//
// triangles, depths  a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; of the lights only directional ones are read
// background  of pixels without a surface
// first, second, coats, specular  out: the geometry buffer (kernels/resolve/gbuffer.h); coats and specular
//             null: none is wanted. With -DSAMPLES each sample has its pixel's surface
// image       out: RGBA a pixel, what surfaces show without point and spot lights; null: the light pass adds
// it
//
// -DTILE         pixels a side, a multiple of 8 (default 16)
// -DBUFFER_BITS  kernels/resolve/gbuffer.h
// -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_surface.h"

kernel void resolve_gbuffer(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                            float4 background, SURFACE_IMAGES) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const SurfaceImages images = GIVEN_SURFACE_IMAGES;
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      const Attributes* a = block_attributes(&walk, covered, x, y);
      Surface s = {0};
      add_materials(&s, a, &scene, covered);
      const TexelPlaces places = texels_of_block(x, y, width, height);
      store_surface(&images, a, &s, covered, &places);
      if (!image) continue;
      const real depth = block_depths(&walk, depths, x, y);
      light_pixels(&lights.lights, x, y, view);
      const ShadingPoint p =
          resolved_point(a, &s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth, covered, view);
      const Real3 shown = base_light(&p, &s, covered, &lights, view);
      store_block(image,
                  real3(covered ? shown.x : REAL(background.x), covered ? shown.y : REAL(background.y),
                        covered ? shown.z : REAL(background.z)),
                  REAL(1.0f), x, y, width, height);
    }
  }
}
