// Where a masked triangle lets light through: below its material's cutoff, as shading looks alpha up, but at
// the base level, since a shadow has no pixel to filter for. Blended triangles hide the share alpha of a
// light everywhere (veils).
//
// -DRAYS_MASKS  some casting triangle has an alpha material
// -DRAYS_VEILS  some is blended
#pragma once

#include "kernels/common/surface_alpha.h"

typedef struct RayMasks {
  global const uint4* of_place;  // material, and vertices of the corners, a triangle in the tree's order
  AlphaSource alphas;
} RayMasks;

// Alpha of the triangle at `place`, where it is met with these weights of its corners, of any sum.
static inline real alpha_of_hit(const RayMasks* masks, int place, real first, real second, real third) {
  const AlphaSource* s = &masks->alphas;
  const uint4 mask = masks->of_place[place];
  global const SurfaceMaterial* m = s->materials + (mask.x & ~RAY_BLENDS);
  const real sum = first + second + third;
  const Weights w = {first / sum, second / sum, sum, sum};
  const CornerAttributes corners = corner_attributes(s->vertices, mask.y, mask.z, mask.w);
  const real alpha = m->base_color[3] * ATTRIBUTE(corners, w, sf);
  if (!(m->flags & 1u << SURFACE_BASE_COLOR)) return alpha;
  global const SurfaceMap* map = m->maps + SURFACE_BASE_COLOR;
  const bool other = map->flags & MAP_UV1;
  const TexturePlace given = {other ? ATTRIBUTE(corners, w, sa) : ATTRIBUTE(corners, w, s8),
                              other ? ATTRIBUTE(corners, w, sb) : ATTRIBUTE(corners, w, s9),
                              0.0f,
                              0.0f,
                              0.0f,
                              0.0f};
  const TexturePlace p = place_in_map(map, given);
  const real u = folded(p.u, map->flags & MAP_CLAMP_U, map->flags & MAP_MIRROR_U);
  const real v = folded(p.v, map->flags & MAP_CLAMP_V, map->flags & MAP_MIRROR_V);
  const mask_t nearest = (mask_t)(map->flags & MAP_MAGNIFY_NEAREST ? -1 : 0);
  const LevelFootprint f = footprint_in_level(map, (whole)(0), u, v, nearest);
  return alpha * bilinear_alpha(s->alphas + m->alpha_base, f) * (1.0f / 255.0f);
}

// Lanes of which it hides the light.
static inline mask_t hides_by_mask(const RayMasks* masks, int place, real first, real second, real third) {
  return passes_mask(&masks->alphas, masks->of_place[place].x & ~RAY_BLENDS,
                     alpha_of_hit(masks, place, first, second, third));
}

#ifdef RAYS_VEILS
// Triangles that are met one after the other let the product of 1 - alpha through. It is kept as the sum of
// its binary logarithms in whole numbers, 2^-16 each, negated: no order of the triangles changes a bit.
#define MOST_VEIL (24 << 16)

// Within 2^-16: ln m = 2 atanh((m - 1) / (m + 1)), m from 0.7 to 1.42.
static inline whole veil_of(real alpha) {
  const real through = 1.0f - lane_min(lane_max(alpha, REAL(0.0f)), REAL(1.0f));
  const whole bits = bits_of_real(through);
  const real mantissa = real_of_bits((bits & 0x7fffff) | 0x3f800000);
  const mask_t high = mantissa > 1.41421356f;
  const real m = high ? mantissa * 0.5f : mantissa,
             power = TO_REAL((bits >> 23) - 127) + (high ? REAL(1.0f) : REAL(0.0f));
  const real s = (m - 1.0f) / (m + 1.0f), q = s * s;
  const real series =
      fma(fma(fma(REAL(0.41219858f), q, REAL(0.57707802f)), q, REAL(0.96179669f)), q, REAL(2.8853901f));
  const real veil = -65536.0f * fma(series, s, power);
  return through > 0x1p-24f ? min(TO_WHOLE(lane_max(veil, REAL(0.0f)) + 0.5f), (whole)(MOST_VEIL))
                            : (whole)(MOST_VEIL);
}

// 255ths of a light that a veil hides: 2^-x by Taylor's series, within 2e-7.
static inline whole share_of_veil(whole veil) {
  const real x = TO_REAL(veil & 0xffff) * (-0.69314718f / 65536.0f);
  real power = fma(x, REAL(1.0f / 5040), REAL(1.0f / 720));
  power = fma(power, x, REAL(1.0f / 120));
  power = fma(power, x, REAL(1.0f / 24));
  power = fma(power, x, REAL(1.0f / 6));
  power = fma(power, x, REAL(0.5f));
  power = fma(fma(power, x, REAL(1.0f)), x, REAL(1.0f));
  const real through = power * real_of_bits((127 - (veil >> 16)) << 23);
  return TO_WHOLE(fma(-through, REAL(255.0f), REAL(255.0f)) + 0.5f);
}
#endif
