// Resolves the surfaces of pixels at edges, for GPUs: one work-item per pixel, surface after surface. As
// resolve/cpu/resolve_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/output.h"
#include "kernels/resolve/pixel_surfaces.h"
#include "shared/average.h"
#include "shared/light_grid.h"
#include "kernels/resolve/traced_edges.h"

kernel void resolve_edges(TRACED_ARGUMENTS global const uint* triangles, global const float* depths,
                          global const ushort* edges, OUTPUT_ARGUMENTS RESOLVE_ARGUMENTS) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!at_edge(edges, at)) return;
  const Output output = GIVEN_OUTPUT;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  take_list(&lights, light_indices, cells, cell_of_pixel(x, y, view->tile_size, view->tiles_x), view);
  LIGHT_EDGES
  // The background comes first, as it does where it needs no shading.
  const uint missed = missed_samples(triangles, at);
  const float4 behind = missed ? background_of(output.background, at, &lights, view) : (float4)(0.0f);
  float4 color = begun_with(behind, share_of(missed));
  for (uint left = ALL_SAMPLES & ~missed; left != 0;) {
    const ResolvedSurface s = next_resolved(triangles, depths, at, &left, x, y, &scene);
    const Resolved r = {&s.attributes, &s.material, s.x, s.y, s.depth, 1};
#ifdef SHADOWS_TRACED
    trace_from(&traced, 1, r.x, r.y, r.depth, view);
    trace_from_triangle(&traced, s.triangle, triangle_instance, 1);
#endif
    const Where where = {{at, s.samples}, s.triangle};
    store_resolved(&output, &r, &where, &scene, &lights, view);
    if (!SHOWS_LIGHT(output)) continue;
    const Real3 shown = light_of(&output, &r, &where, &lights, bin_edges, view);
    color = add_light(color, (float3)(shown.x, shown.y, shown.z), share_of(s.samples));
  }
  if (SHOWS_LIGHT(output)) ((global float4*)output.image)[at] = averaged(color);
}
