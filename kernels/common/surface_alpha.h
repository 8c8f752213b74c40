// Which pixels of a triangle a masked material shows: the rasteriser's side of the textures.
#pragma once

#include "kernels/common/surface_attributes.h"

static inline whole gathered(global const uint* from, whole at) {
#if LANES == 1
  return (int)from[at];
#else
  return as_int16((uint16)(from[at.s0], from[at.s1], from[at.s2], from[at.s3], from[at.s4], from[at.s5],
                           from[at.s6], from[at.s7], from[at.s8], from[at.s9], from[at.sa], from[at.sb],
                           from[at.sc], from[at.sd], from[at.se], from[at.sf]));
#endif
}

static inline real bilinear_alpha(global const uint* chain, LevelFootprint f) {
  const whole quad = gathered(chain, f.first);
  const real a = TO_REAL(quad & 255), b = TO_REAL(quad >> 8 & 255), c = TO_REAL(quad >> 16 & 255),
             d = TO_REAL(quad >> 24 & 255);
  const real low = fma(c - a, f.y, a), high = fma(d - b, f.y, b);
  return fma(high - low, f.x, low);
}

// From 0 to 1. The map's levels are those of its chain of alphas, which begins at `base`.
static inline real filtered_alpha(global const uint* alphas, uint base, global const SurfaceMap* map,
                                  TexturePlace place) {
  const Footprint f = footprint_of(map, place);
  const real fine = bilinear_alpha(alphas + base, f.fine), coarse = bilinear_alpha(alphas + base, f.coarse);
  return fma(coarse - fine, f.mix, fine) * (1.0f / 255.0f);
}

// A mask is looked up in these: ClScene's buffers (shared/surface_records.h), and half the image's size in
// pixels.
typedef struct AlphaSource {
  global const SurfaceVertex* vertices;
  global const SurfaceMaterial* materials;
  global const uint* alphas;
  float2 half_size;
} AlphaSource;

// The base colour's alpha at LANES places, dx and dy from the first pixel (x, y) of their block of 4 x 4. a,
// b, c: the corners in clip space; i, j, k: their vertices. side: of the square whose texels are filtered,
// pixels.
static inline real alpha_at(const AlphaSource* s, uint material, float4 a, float4 b, float4 c, uint i, uint j,
                            uint k, float x, float y, real dx, real dy, float side) {
  global const SurfaceMaterial* m = s->materials + material;
  const ScreenTriangle t = screen_triangle(a, b, c, x, y, s->half_size);
  const Weights w = weights_at(&t, dx, dy);
  const CornerAttributes corners = corner_attributes(s->vertices, i, j, k);
  const real alpha = m->base_color[3] * ATTRIBUTE(corners, w, sf);
  if (!(m->flags & 1u << SURFACE_BASE_COLOR)) return alpha;
  global const SurfaceMap* map = m->maps + SURFACE_BASE_COLOR;
  TexturePlace place =
      map->flags & MAP_UV1 ? TEXTURE_PLACE(corners, w, &t, sa, sb) : TEXTURE_PLACE(corners, w, &t, s8, s9);
  place.u_right *= side;
  place.v_right *= side;
  place.u_up *= side;
  place.v_up *= side;
  return alpha * filtered_alpha(s->alphas, m->alpha_base, map, place);
}

// A pixel whose alpha is less than the cutoff shows nothing (glTF 2.0, 3.9.4).
static inline mask_t passes_mask(const AlphaSource* s, uint material, real alpha) {
  return alpha >= REAL(s->materials[material].alpha_cutoff);
}
