// Which pixels of a triangle a masked material shows: the rasteriser's side of the textures.
#pragma once

#include "kernels/common/surface_attributes.h"

// What a mask is looked up in: ClScene's buffers (shared/surface_records.h), and half the image's size in
// pixels.
typedef struct AlphaSource {
  global const SurfaceVertex* vertices;
  global const SurfaceMaterial* materials;
  global const uint* alphas;
  float2 half_size;
} AlphaSource;

// The base colour's alpha at LANES pixels, dx and dy from the first pixel (x, y) of their block of 4 x 4. a,
// b, c: the corners in clip space; i, j, k: their vertices.
static inline real alpha_at(const AlphaSource* s, uint material, float4 a, float4 b, float4 c, uint i, uint j,
                            uint k, float x, float y, real dx, real dy) {
  global const SurfaceMaterial* m = s->materials + material;
  const ScreenTriangle t = screen_triangle(a, b, c, x, y, s->half_size);
  const Weights w = weights_at(&t, dx, dy);
  const CornerAttributes corners = corner_attributes(s->vertices, i, j, k);
  const real alpha = m->base_color[3] * ATTRIBUTE(corners, w, sf);
  if (!(m->flags & 1u << SURFACE_BASE_COLOR)) return alpha;
  global const SurfaceMap* map = m->maps + SURFACE_BASE_COLOR;
  const TexturePlace place =
      map->flags & MAP_UV1 ? TEXTURE_PLACE(corners, w, &t, sa, sb) : TEXTURE_PLACE(corners, w, &t, s8, s9);
  return alpha * filtered_alpha(s->alphas, m->alpha_base, map, place);
}

// A pixel whose alpha is less than the cutoff shows nothing (glTF 2.0, 3.9.4).
static inline mask_t passes_mask(const AlphaSource* s, uint material, real alpha) {
  return alpha >= REAL(s->materials[material].alpha_cutoff);
}
