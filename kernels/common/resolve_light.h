// Radiance of resolved surfaces: what they show of themselves, directional lights, then point and spot
// lights, in the order of forward's shader (shaders/forward.frag).
//
// -DDIRECTIONAL  there are directional lights
// -DINDEX_32, -DZ_BINS, -DSPOTS, -DBLINN  as kernels/common/shade_pixels.h says
#pragma once

#include "kernels/common/resolve.h"
#include "kernels/common/shade_pixels.h"

// What all kernels that resolve triangles take, and the same as members of ResolveScene and ResolveLights.
// What a triangle number leads to (raster/rasterizer.h); surfaces, vertices and materials
// (shared/surface_records.h); chains of texels (renderer/texel_chain.h); lights (shared/punctual_light.h),
// directional ones two float4 each; the light grid (shared/light_grid.h), or null for every light at every
// pixel: the same sum, since a list leaves out only zeros; with -DZ_BINS z-bins of each light, and the depth
// keys between them.
#define RESOLVE_ARGUMENTS                                                                            \
  global const uint *triangle_instance, global const RasterInstanceRecord *instances,                \
      global const uint *indices, global const float4 *clip, global const SurfaceInstance *surfaces, \
      global const SurfaceVertex *vertices, global const SurfaceMaterial *materials,                 \
      global const ushort *texels_4, global const ushort *texels_8, global const float4 *positions,  \
      global const float4 *colors, global const float4 *cones, global const float4 *directional,     \
      global const uint2 *cells, global const index_t *light_indices, global const uint *light_bins, \
      constant float *bin_edges, constant ViewParams *view
#define RESOLVE_SCENE                                                                               \
  {                                                                                                 \
    triangle_instance, instances, surfaces, indices, clip, vertices, materials, texels_4, texels_8, \
        (float2)(0.5f * (float)view->width, 0.5f * (float)view->height)                             \
  }
#define RESOLVE_LIGHTS \
  { {positions, colors, cones, light_bins}, directional, light_indices, 0 }

typedef struct ResolveLights {
  Lights lights;
  global const float4* directional;  // two each: direction to the light, and illuminance
  global const index_t* list;  // null: all of them
  uint count;
} ResolveLights;

// The list of a tile's cell.
static inline void take_list(ResolveLights* l, global const index_t* light_indices, global const uint2* cells,
                             uint cell, constant ViewParams* view) {
  l->list = cells ? light_indices + cells[cell].x : 0;
  l->count = cells ? cells[cell].y : view->light_count;
}

static inline Real3 own_light(const ShadingPoint* p, const Surface* s, const ResolveLights* l,
                              constant ViewParams* view) {
  const Real3 ambient =
      reflected_ambient(*p, REAL(view->ambient_r), REAL(view->ambient_g), REAL(view->ambient_b));
  Real3 sum = add3(s->emissive, scale3(ambient, s->occlusion));
#ifdef DIRECTIONAL
  for (uint i = 0; i < view->directional_count; ++i) {
    const float4 to_light = l->directional[2 * i], light = l->directional[2 * i + 1];
    const Real3 back = reflected(*p, real3(REAL(to_light.x), REAL(to_light.y), REAL(to_light.z)));
    sum = add3(sum, real3(back.x * light.x, back.y * light.y, back.z * light.z));
  }
#endif
  return sum;
}

// x, y: pixel centres. lit: lanes with a surface that light reaches.
static inline Real3 radiance(const Attributes* a, const Surface* s, real x, real y, real depth, mask_t lit,
                             const ResolveLights* l, constant float* bin_edges, constant ViewParams* view) {
  const Real3 position = position_of_pixel(x, y, lit ? depth : REAL(1.0f), view);
  const ShadingPoint p = shading_point(position, direction_to_viewer(position), shading_normal(a, s),
                                       s->base_color, s->metallic, s->roughness);
  Real3 sum = own_light(&p, s, l, view);
  sum = sum_of_list(sum, &p, lit, l->list, l->count, bins_of_pixels(depth, lit, bin_edges), &l->lights);
  return real3(s->unlit ? s->base_color.x : sum.x, s->unlit ? s->base_color.y : sum.y,
               s->unlit ? s->base_color.z : sum.z);
}
