// The surfaces of pixels at edges into a geometry buffer of samples, for CPUs: each surface once a pixel, at
// the centroid of the samples that see it, for which it is stored. A work-item takes a tile, 16 surfaces at a
// time (kernels/resolve/edge_surfaces.h). Other pixels, and samples without a surface, keep what
// resolve_gbuffer stored.
//
// triangles, depths, edges  as edge_surfaces.h says
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; of the lights only directional ones are read
// background         of samples without a surface
// first, second, coats, specular, image  in and out: as resolve_gbuffer.cl; the image takes the mean over the
//                    samples
// -DBUFFER_BITS      kernels/resolve/gbuffer.h
// and what edge_surfaces.h and resolve_light.h name
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/resolve/edge_surfaces.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_surface.h"

kernel void resolve_gbuffer_edges(global const uint* triangles, global const float* depths,
                                  global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                                  SURFACE_IMAGES) {
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1), width = view->width, height = view->height;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const SurfaceImages images = GIVEN_SURFACE_IMAGES;
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
  EdgeSurfaces e;
  EdgeBatch b;
  for (uint y0 = tile_y * TILE; y0 < min(tile_y * TILE + TILE, height); y0 += SIDE) {
    for (uint x0 = tile_x * TILE; x0 < min(tile_x * TILE + TILE, width); x0 += SIDE) {
      find_edge_surfaces(&e, triangles, depths, edges, x0, y0, width, height);
      for (uint i = 0; i < e.count; i += 16) {
        take_batch(&b, &e, i, &scene);
        const TexelPlaces places = texels_of_batch(&e, i);
        store_surface(&images, &b.attributes, &b.material, b.covered, &places);
        if (!image) continue;
        const ShadingPoint p = resolved_point(&b.attributes, &b.material, b.x, b.y, b.depth, b.covered, view);
        keep_light(&e, &b, base_light(&p, &b.material, b.covered, &lights, view));
      }
      if (image) show_edges(&e, background, image);
    }
  }
}
