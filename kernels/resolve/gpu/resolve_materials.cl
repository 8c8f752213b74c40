// Radiance of every pixel of a visibility buffer under its sums of light, for GPUs: a work-item a pixel. As
// resolve/cpu/resolve_materials.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/resolve_sums.h"

kernel void resolve_materials(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                              float4 background, global const light_channel_t* first,
                              global const light_channel_t* second, float scale, float exponent,
                              float reference, global float* image) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  float4 color = background;
  if (triangle != SURFACE_NONE) {
    const ResolveScene scene = RESOLVE_SCENE;
    ResolveLights lights = RESOLVE_LIGHTS;
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
    const LightBufferParams of = {exponent, reference};
    light_pixels(&lights.lights, x, y, view);
    Real3 shown = real3(0.0f, 0.0f, 0.0f);
    for (uint sample = 0; sample < READ_SAMPLES; ++sample) {
      const size_t in_buffer = at * SAMPLES + sample;
      const Real3 one = radiance_of_sums(&a, &s, (float)x + 0.5f, (float)y + 0.5f, depths[at], 1,
                                         stored_sums(first, second, scale, &in_buffer), of, &lights, view);
      shown = add3(shown, scale3(one, 1.0f / READ_SAMPLES));
    }
    color = (float4)(shown.x, shown.y, shown.z, 1.0f);
  }
  ((global float4*)image)[at] = color;
}
