// Radiance of pixels at edges, for CPUs: a work-item takes a tile, and of it squares of EDGE_BLOCK pixels,
// whose surfaces are shaded 16 at a time (kernels/resolve/edge_surfaces.h). Other pixels keep their colours.
//
// triangles, depths, edges  as edge_surfaces.h says
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h
// background         of samples without a surface
// image              in and out: RGBA a pixel, linear, row 0 at the bottom
// -DSHADOWS_TRACED   some light casts a shadow in this view: TRACED_ARGUMENTS come first
//                    (kernels/shadows/traced_shadows.h)
// and what edge_surfaces.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/edge_surfaces.h"
#include "kernels/resolve/resolve_light.h"
#ifdef SHADOWS_TRACED
#include "kernels/shadows/traced_shadows.h"

static inline void trace_from_batch(TracedShadows* traced, const EdgeBatch* b, const ResolveScene* scene,
                                    constant ViewParams* view) {
  trace_from(traced, b->covered, b->x, b->y, b->depth, view);
  for (uint left = mask_bits(b->covered); left != 0;) {
    const uint one = ((const uint*)&b->triangle)[lowest_bit(left)];
    const mask_t here = b->triangle == (uint16)(one);
    left &= ~mask_bits(here);
    trace_from_triangle(traced, one, scene->triangle_instance, here);
  }
}
#else
#define TRACED_ARGUMENTS
#endif

kernel void resolve_edges(TRACED_ARGUMENTS global const uint* triangles, global const float* depths,
                          global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                          global float* image) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, tile_y * view->tiles_x + tile_x, view);
#ifdef SHADOWS_TRACED
  TracedShadows traced = TRACED_SHADOWS;
  lights.lights.shadows.traced = &traced;
#elif defined(SHADOWS)
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
#endif
  EdgeSurfaces e;
  EdgeBatch b;
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      find_edge_surfaces(&e, triangles, depths, edges, x0, y0, width, height);
      for (uint i = 0; i < e.count; i += 16) {
        take_batch(&b, &e, i, &scene);
#ifdef SHADOWS_TRACED
        trace_from_batch(&traced, &b, &scene, view);
#endif
        keep_light(
            &e, &b,
            radiance(&b.attributes, &b.material, b.x, b.y, b.depth, b.covered, &lights, bin_edges, view));
      }
      show_edges(&e, background, image);
    }
  }
}
