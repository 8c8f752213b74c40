// Which samples of its triangles a masked material shows, for kernels that rasterise.
//
// -DALPHA_MASKS  some instance has an alpha material; without, masks are not looked up and MASK_ARGUMENTS not
// read
// Of several samples a pixel (shared/sample_masks.h); without a define as its centre is shown:
// -DMASKS_AT_SAMPLES   one look-up a sample, of the texels that are its share of the pixel
// -DMASKS_BY_COVERAGE  three a pixel, for alpha and its slope: alpha to coverage, sharpened around the cutoff
//                      (Castano, "Computing Alpha Mipmaps", 2010; Golus, "Anti-aliased Alpha Test", 2017),
//                      with the samples that lie on the slope's side
#pragma once

#include "kernels/common/pack.h"
#include "kernels/common/sample_places.h"
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
  float2 half_size;  // half the image's size, pixels
} MaskSource;

#ifdef ALPHA_MASKS
#include "kernels/common/surface_alpha.h"

// A triangle with such a material, seen from the block of 4 x 4 pixels whose first one is (x, y).
typedef struct MaskedTriangle {
  AlphaSource source;
  uint material;
  float4 clip[3];
  uint corners[3];
  float x, y;
} MaskedTriangle;

static inline MaskedTriangle masked_triangle(const MaskSource* m, uint triangle, uint instance, uint material,
                                             float x, float y) {
  const RasterInstanceRecord i = m->instances[instance];
  global const uint* index = m->indices + i.first_index + 3 * (size_t)(triangle - i.first_triangle);
  global const float4* clip = m->clip + i.first_clip_vertex;
  const uint a = index[0], b = index[1], c = index[2];
  const MaskedTriangle t = {{m->vertices + i.first_vertex, m->materials, m->alphas, m->half_size},
                            material,
                            {clip[a], clip[b], clip[c]},
                            {a, b, c},
                            x,
                            y};
  return t;
}

// side: of the square whose texels are filtered, pixels.
static inline real mask_alpha(const MaskedTriangle* t, real dx, real dy, float side) {
  return alpha_at(&t->source, t->material, t->clip[0], t->clip[1], t->clip[2], t->corners[0], t->corners[1],
                  t->corners[2], t->x, t->y, dx, dy, side);
}

// Takes the samples that the mask hides from `shown`, a value a sample. At LANES pixels, dx and dy from the
// block's first one.
static inline void apply_mask(const MaskedTriangle* t, real dx, real dy, mask_t* shown) {
#if SAMPLES > 1 && defined(MASKS_AT_SAMPLES)
  for (int s = 0; s < SAMPLES; ++s) {
    if (!any_lane(shown[s])) continue;
    const real alpha = mask_alpha(t, dx + SAMPLE_X(s), dy + SAMPLE_Y(s), SAMPLE_SIDE);
    shown[s] &= passes_mask(&t->source, t->material, alpha);
  }
#elif SAMPLES > 1 && defined(MASKS_BY_COVERAGE)
  const real alpha = mask_alpha(t, dx, dy, 1.0f), right = mask_alpha(t, dx + 1.0f, dy, 1.0f) - alpha,
             up = mask_alpha(t, dx, dy + 1.0f, 1.0f) - alpha;
  for (int s = 0; s < SAMPLES; ++s)
    shown[s] &= passes_mask(&t->source, t->material,
                            fma(right, REAL(SAMPLE_X(s)), fma(up, REAL(SAMPLE_Y(s)), alpha)));
#else
  const mask_t passes = passes_mask(&t->source, t->material, mask_alpha(t, dx, dy, 1.0f));
  for (int s = 0; s < SAMPLES; ++s) shown[s] &= passes;
#endif
}
#endif
