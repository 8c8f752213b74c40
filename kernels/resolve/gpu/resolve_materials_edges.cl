// Radiance of pixels at edges under the sums of light of their samples, for GPUs: a work-item a pixel,
// surface after surface. As resolve/cpu/resolve_materials_edges.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/pixel_surfaces.h"
#include "kernels/resolve/resolve_sums.h"
#include "shared/average.h"

kernel void resolve_materials_edges(global const uint* triangles, global const float* depths,
                                    global const ushort* edges, RESOLVE_ARGUMENTS, float4 background,
                                    global const light_channel_t* first, global const light_channel_t* second,
                                    float scale, float exponent, float reference, global float* image) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint at = y * view->width + x;
  if (!at_edge(edges, at)) return;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
  const LightBufferParams of = {exponent, reference};
  light_pixels(&lights.lights, 0, 0, view);  // of any pixel: no light is hidden
  const uint missed = missed_samples(triangles, at);
  float4 color = begun_with(background, share_of(missed));
  for (uint left = ALL_SAMPLES & ~missed; left != 0;) {
    const ResolvedSurface r = next_resolved(triangles, depths, at, &left, x, y, &scene);
    const float share = 1.0f / (float)popcount(r.samples);
    Real3 shown = real3(0.0f, 0.0f, 0.0f);
    for (uint of_surface = r.samples; of_surface != 0; of_surface &= of_surface - 1) {
      const size_t in_buffer = (size_t)at * SAMPLES + lowest_bit(of_surface);
      const Real3 one = radiance_of_sums(&r.attributes, &r.material, r.x, r.y, r.depth, 1,
                                         stored_sums(first, second, scale, &in_buffer), of, &lights, view);
      shown = add3(shown, real3(one.x * share, one.y * share, one.z * share));
    }
    color = add_light(color, (float3)(shown.x, shown.y, shown.z), share_of(r.samples));
  }
  ((global float4*)image)[at] = averaged(color);
}
