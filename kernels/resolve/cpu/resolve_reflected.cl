// What each pixel of a light's view reflects of that light, for CPUs: a work-item takes a tile, block after
// block of 4 x 4 pixels. As resolve/cpu/resolve.cl up to the surfaces.
//
// triangles, depths  a pixel each, row 0 at the bottom: a triangle number or SURFACE_NONE; reversed depth
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; no light grid is read
// light      in the light table; the view's eye is at its position
// flux       out: RGB flux and area a pixel (kernels/resolve/reflected_light.h)
// places     out: normal and distance ahead a pixel
// -DTILE     pixels a side, a multiple of 8 (default 16)
// and what kernels/resolve/resolve.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/resolve_block.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/reflected_light.h"

kernel void resolve_reflected(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                              uint light, global float* flux, global float* places) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  const ResolveLights lights = RESOLVE_LIGHTS;
  const PunctualLight from = light_at(&lights.lights, light);
  BlockWalk walk = walk_tile(&scene, triangles, tile_x, tile_y, width, height);
  for (uint y = walk.y0; y < walk.y_end; y += 4) {
    for (uint x = walk.x0; x < walk.x_end; x += 4) {
      const mask_t covered = walk_to(&walk, x, y);
      const Attributes* a = block_attributes(&walk, covered, x, y);
      Surface s = {0};
      add_materials(&s, a, &scene, covered);
      const real depth = block_depths(&walk, depths, x, y);
      const ShadingPoint p =
          resolved_point(a, &s, (float)x + 0.5f + BLOCK_DX, (float)y + 0.5f + BLOCK_DY, depth, covered, view);
      Real3 plane = real3(REAL(0.0f), REAL(0.0f), REAL(0.0f));
      const uint16 triangle = load_block(triangles, x, y, width, height);
      for (uint left = mask_bits(covered); left != 0;) {
        const uint one = ((const uint*)&triangle)[lowest_bit(left)];
        const mask_t here = covered & (triangle == (uint16)(one));
        left &= ~mask_bits(here);
        add_plane(&plane, &scene, one, here, view);
      }
      const ReflectedLight r = reflected_light(p, s.unlit, plane, covered, from, view);
      store_block(flux, r.flux, r.area, x, y, width, height);
      store_block(places, r.normal, r.ahead, x, y, width, height);
    }
  }
}
