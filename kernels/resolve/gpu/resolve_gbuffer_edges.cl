// The surfaces of pixels at edges into a geometry buffer of samples, for GPUs: a work-item a pixel, surface
// after surface. As resolve/cpu/resolve_gbuffer_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/pixel_surfaces.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/store_surface.h"
#include "shared/average.h"

kernel void resolve_gbuffer_edges(global const uint* triangles, global const float* depths,
                                  global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                                  SURFACE_IMAGES) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!at_edge(edges, at)) return;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const SurfaceImages images = GIVEN_SURFACE_IMAGES;
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
  const uint missed = missed_samples(triangles, at);
  float4 color = begun_with(background, share_of(missed));
  for (uint left = ALL_SAMPLES & ~missed; left != 0;) {
    const ResolvedSurface r = next_resolved(triangles, depths, at, &left, x, y, &scene);
    const TexelPlaces places = {at, r.samples};
    store_surface(&images, &r.attributes, &r.material, 1, &places);
    if (!image) continue;
    const ShadingPoint p = resolved_point(&r.attributes, &r.material, r.x, r.y, r.depth, 1, view);
    const Real3 base = base_light(&p, &r.material, 1, &lights, view);
    color = add_light(color, (float3)(base.x, base.y, base.z), share_of(r.samples));
  }
  if (image) ((global float4*)image)[at] = averaged(color);
}
