// Radiance of every pixel of a visibility buffer, for GPUs: a work-item a pixel. As resolve/cpu/resolve.cl, with the
// same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/resolve_light.h"
#include "shared/light_grid.h"

kernel void resolve(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                    float4 background, global float* image) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  float4 color = background;
  if (triangle != SURFACE_NONE) {
    const ResolveScene scene = RESOLVE_SCENE;
    ResolveLights lights = RESOLVE_LIGHTS;
    take_list(&lights, light_indices, cells, cell_of_pixel(x, y, view->tile_size, view->tiles_x), view);
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
    light_pixels(&lights.lights, x, y, view);
    const Real3 shown =
        radiance(&a, &s, (float)x + 0.5f, (float)y + 0.5f, depths[at], 1, &lights, bin_edges, view);
    color = (float4)(shown.x, shown.y, shown.z, 1.0f);
  }
  ((global float4*)image)[at] = color;
}
