// Radiance of pixels at edges, for GPUs: a work-item a pixel, surface after surface. As
// resolve/cpu/resolve_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "shared/average.h"
#include "kernels/resolve/resolve_light.h"
#include "kernels/resolve/samples.h"
#include "shared/light_grid.h"
#ifdef SHADOWS_TRACED
#include "kernels/shadows/traced_shadows.h"
#else
#define TRACED_ARGUMENTS
#endif

kernel void resolve_edges(TRACED_ARGUMENTS global const uint* triangles, global const float* depths,
                          global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                          global float* image) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!(edges[at / 16] >> (at & 15u) & 1u)) return;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, cell_of_pixel(x, y, view->tile_size, view->tiles_x), view);
#ifdef SHADOWS_TRACED
  TracedShadows traced = TRACED_SHADOWS;
  lights.lights.shadows.traced = &traced;
#elif defined(SHADOWS)
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
#endif
  const uint base_x = x & ~(EDGE_BLOCK - 1u), base_y = y & ~(EDGE_BLOCK - 1u);
  // The background comes first, as it does where it needs no shading.
  uint missed = 0;
  for (uint s = 0; s < SAMPLES; ++s)
    missed |= triangles[(size_t)at * SAMPLES + s] == SURFACE_NONE ? 1u << s : 0u;
  float4 color = begun_with(background, share_of(missed));
  for (uint left = ALL_SAMPLES & ~missed; left != 0;) {
    const PixelSurface p =
        next_surface(triangles + (size_t)at * SAMPLES, depths + (size_t)at * SAMPLES, &left);
    const float dx = (float)(x - base_x) + p.off_x, dy = (float)(y - base_y) + p.off_y;
    const float x_here = (float)base_x + 0.5f + dx, y_here = (float)base_y + 0.5f + dy;
#ifdef SHADOWS_TRACED
    trace_from(&traced, 1, x_here, y_here, p.depth, view);
    trace_from_triangle(&traced, p.triangle, triangle_instance, 1);
#endif
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, p.triangle, 1, (float)base_x, (float)base_y, dx, dy);
    add_material(&s, &a, &scene, (uint)a.material, 1);
    const Real3 shown = radiance(&a, &s, x_here, y_here, p.depth, 1, &lights, bin_edges, view);
    color = add_light(color, (float3)(shown.x, shown.y, shown.z), share_of(p.samples));
  }
  ((global float4*)image)[at] = averaged(color);
}
