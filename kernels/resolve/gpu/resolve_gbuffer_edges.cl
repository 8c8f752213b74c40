// The surfaces of pixels at edges into a geometry buffer of samples, for GPUs: a work-item a pixel, surface
// after surface. As resolve/cpu/resolve_gbuffer_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "shared/average.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/samples.h"
#include "kernels/resolve/store_surface.h"

kernel void resolve_gbuffer_edges(global const uint* triangles, global const float* depths,
                                  global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                                  SURFACE_IMAGES) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!(edges[at / 16] >> (at & 15u) & 1u)) return;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const SurfaceImages images = GIVEN_SURFACE_IMAGES;
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
  const uint base_x = x & ~(EDGE_BLOCK - 1u), base_y = y & ~(EDGE_BLOCK - 1u);
  uint missed = 0;
  for (uint s = 0; s < SAMPLES; ++s)
    missed |= triangles[(size_t)at * SAMPLES + s] == SURFACE_NONE ? 1u << s : 0u;
  float4 color = begun_with(background, share_of(missed));
  for (uint left = ALL_SAMPLES & ~missed; left != 0;) {
    const PixelSurface p =
        next_surface(triangles + (size_t)at * SAMPLES, depths + (size_t)at * SAMPLES, &left);
    const float dx = (float)(x - base_x) + p.off_x, dy = (float)(y - base_y) + p.off_y;
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, p.triangle, 1, (float)base_x, (float)base_y, dx, dy);
    add_material(&s, &a, &scene, (uint)a.material, 1);
    const TexelPlaces places = {at, p.samples};
    store_surface(&images, &a, &s, 1, &places);
    if (!image) continue;
    const ShadingPoint q =
        resolved_point(&a, &s, (float)base_x + 0.5f + dx, (float)base_y + 0.5f + dy, p.depth, 1, view);
    const Real3 base = base_light(&q, &s, 1, &lights, view);
    color = add_light(color, (float3)(base.x, base.y, base.z), share_of(p.samples));
  }
  if (image) ((global float4*)image)[at] = averaged(color);
}
