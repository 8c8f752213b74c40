// Where a masked triangle lets light through: below its material's cutoff, as shading looks alpha up, but at
// the base level, since a shadow has no pixel to filter for.
//
// -DRAYS_MASKS  some casting triangle has an alpha material
#pragma once

#include "kernels/resolve/surface_alpha.h"

typedef struct RayMasks {
  global const uint4* of_place;  // material, and vertices of the corners, a triangle in the tree's order
  AlphaSource alphas;
} RayMasks;

// Lanes of which the triangle at `place` hides the light, where it is met with these weights of its corners,
// of any sum.
static inline mask_t hides_by_mask(const RayMasks* masks, int place, real first, real second, real third) {
  const AlphaSource* s = &masks->alphas;
  const uint4 mask = masks->of_place[place];
  global const SurfaceMaterial* m = s->materials + mask.x;
  const real sum = first + second + third;
  const Weights w = {first / sum, second / sum, sum, sum};
  const CornerAttributes corners = corner_attributes(s->vertices, mask.y, mask.z, mask.w);
  const real alpha = m->base_color[3] * ATTRIBUTE(corners, w, sf);
  if (!(m->flags & 1u << SURFACE_BASE_COLOR)) return passes_mask(s, mask.x, alpha);
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
  return passes_mask(s, mask.x, alpha * bilinear_alpha(s->alphas + m->alpha_base, f) * (1.0f / 255.0f));
}
