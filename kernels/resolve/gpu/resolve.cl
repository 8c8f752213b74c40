// Resolves the surface of every pixel of a visibility buffer, for GPUs: one work-item per pixel. As
// resolve/cpu/resolve.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/output.h"
#include "shared/light_grid.h"

kernel void resolve(global const uint* triangles, global const float* depths,
                    OUTPUT_ARGUMENTS RESOLVE_ARGUMENTS) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  const bool covered = triangle != SURFACE_NONE;
  const Where where = {{at, PIXEL_SAMPLES}, triangle};
  const Output output = GIVEN_OUTPUT;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  Attributes a = {0};
  Surface s = {0};
  if (covered) {
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
  }
  const float depth = covered && READS_DEPTH(output) ? depths[at] : 0.0f;
  const Resolved r = resolved_at(&a, &s, x, y, depth, covered);
  store_resolved(&output, &r, &where, &scene, &lights, view);
  if (!SHOWS_LIGHT(output)) return;
  float4 color;
  if (covered) {
    take_list(&lights, light_indices, cells, cell_of_pixel(x, y, view->tile_size, view->tiles_x), view);
    light_pixels(&lights.lights, x, y, view);
    const Real3 shown = light_of(&output, &r, &where, &lights, bin_edges, view);
    color = (float4)(shown.x, shown.y, shown.z, 1.0f);
  } else {
    color = background_of(output.background, (uint)at, &lights, view);
  }
  ((global float4*)output.image)[at] = color;
}
