// Which pixels of its triangles a masked material shows, for kernels that rasterise.
//
// -DALPHA_MASKS  some instance has an alpha material; without, masks are not looked up and MASK_ARGUMENTS not
// read
#pragma once

#include "kernels/common/pack.h"
#include "shared/raster_instance.h"
#include "shared/surface_records.h"

// Instances, indices (mesh after mesh) and clip-space positions as RasterBuffers has them; RasterMasks.
#define MASK_ARGUMENTS                                                                \
  global const RasterInstanceRecord *mask_instances, global const uint *mask_indices, \
      global const float4 *mask_clip, global const SurfaceVertex *mask_vertices,      \
      global const SurfaceMaterial *mask_materials, global const uint *mask_alphas
#define MASK_SOURCE(params)                                                              \
  {                                                                                      \
    mask_instances, mask_indices, mask_clip, mask_vertices, mask_materials, mask_alphas, \
        (float2)(0.5f * (float)(params)->width, 0.5f * (float)(params)->height)          \
  }

typedef struct MaskSource {
  global const RasterInstanceRecord* instances;
  global const uint* indices;
  global const float4* clip;
  global const SurfaceVertex* vertices;
  global const SurfaceMaterial* materials;
  global const uint* alphas;
  float2 half_size;  // of the image, pixels
} MaskSource;

#ifdef ALPHA_MASKS
#include "kernels/resolve/surface_alpha.h"

// At LANES pixels, dx and dy from the first pixel (x, y) of their block of 4 x 4.
static inline mask_t shown_by_mask(const MaskSource* m, uint triangle, uint instance, uint material, float x,
                                   float y, real dx, real dy) {
  const RasterInstanceRecord i = m->instances[instance];
  global const uint* index = m->indices + i.first_index + 3 * (size_t)(triangle - i.first_triangle);
  const uint a = index[0], b = index[1], c = index[2];
  global const float4* clip = m->clip + i.first_clip_vertex;
  const AlphaSource source = {m->vertices + i.first_vertex, m->materials, m->alphas, m->half_size};
  return passes_mask(&source, material,
                     alpha_at(&source, material, clip[a], clip[b], clip[c], a, b, c, x, y, dx, dy));
}
#endif
