// The surface of every pixel of a visibility buffer into a geometry buffer, for GPUs: a work-item a pixel. As
// resolve/cpu/resolve_gbuffer.cl, with the same arguments.
#define FUSED  // shared/real.h
#define LANES 1
#include "kernels/resolve/group_numbers.h"
#include "kernels/resolve/resolve_light.h"

#if BUFFER_BITS == 32
#define TO_CHANNELS(texel) (texel)
#elif BUFFER_BITS == 16
#define TO_CHANNELS(texel) convert_ushort4_sat_rte(texel)
#else
#define TO_CHANNELS(texel) convert_uchar4_sat_rte(texel)
#endif

static inline void store_texel(global channel_t* to, Texels t, size_t at) {
  ((global channel4_t*)to)[at] = TO_CHANNELS((float4)(t.x, t.y, t.z, t.w));
}

kernel void resolve_gbuffer(global const uint* triangles, global const float* depths, RESOLVE_ARGUMENTS,
                            float4 background, global channel_t* first, global channel_t* second,
                            global channel_t* coats, global channel_t* specular, global float* image
                            GROUP_NUMBERS_OUT) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const size_t at = (size_t)y * view->width + x;
  const uint triangle = triangles[at];
  Texels normal = {0}, color = {0}, coat = {0}, reflectance = {0};
  float4 shown = background;
  uint group = 0;
  if (triangle != SURFACE_NONE) {
    const ResolveScene scene = RESOLVE_SCENE;
    ResolveLights lights = RESOLVE_LIGHTS;
    Attributes a = {0};
    Surface s = {0};
    add_triangle(&a, &scene, triangle, 1, (float)(x & ~3u), (float)(y & ~3u), (float)(x & 3u),
                 (float)(y & 3u));
    add_material(&s, &a, &scene, (uint)a.material, 1);
    const Real3 n = shading_normal(&a, &s);
    texels_of_surface(&normal, &color, n, s.base_color, s.metallic, s.roughness, number_of(&s), s.unlit, 1);
#ifdef CLEARCOAT
    coat = texels_of_coat(coat_normal(&a, &s), n, s.coat, s.coat_roughness, 1);
#endif
#ifdef SPECULAR
    reflectance = texels_of_specular(s.f0, s.f90, 1);
#endif
#ifdef GROUP_NUMBERS
    group = (uint)a.group_number;
#endif
    if (image) {
      light_pixels(&lights.lights, x, y, view);
      const ShadingPoint p = resolved_point(&a, &s, (float)x + 0.5f, (float)y + 0.5f, depths[at], 1, view);
      const Real3 base = base_light(&p, &s, 1, &lights, view);
      shown = (float4)(base.x, base.y, base.z, 1.0f);
    }
  }
  store_texel(first, normal, at);
  store_texel(second, color, at);
  if (coats) store_texel(coats, coat, at);
  if (specular) store_texel(specular, reflectance, at);
  if (image) ((global float4*)image)[at] = shown;
#ifdef GROUP_NUMBERS
  group_numbers[at] = (group_number_t)group;
#endif
}
