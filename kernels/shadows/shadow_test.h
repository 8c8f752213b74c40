// How a light's shadow is found at LANES pixels: a ray each (ray_test.h), with -DSHADOW_RAYS many to its
// sphere, with -DSHADOW_PICK some for all lights together, or with -DSHADOW_MAP the texels of its map.
//
// -DSHADOW_BYTES  of a light a share may be hidden (shared/shadow_bits.h)
#pragma once

#include "kernels/common/hash.h"  // here, since what is included below under a condition counts as there
#include "kernels/shadows/receivers.h"

#ifdef SHADOW_MAP
#include "kernels/shadow_maps/map_test.h"
#else
#include "kernels/shadows/ray_test.h"
#endif
#if defined(SHADOW_RAYS) || defined(SHADOW_PICK)
#include "kernels/shadows/soft_shadows.h"
#endif
#ifdef SHADOW_PICK
#include "kernels/shadows/picked_shadows.h"
#endif

// The share of each light that is hidden from the lanes, times 255: 0 or 255 without SHADOW_BYTES. block: of
// the lanes in their tile, 0 for a single one. x, y: the first lane's pixel. Directional lights take one ray
// each.
static inline whole hidden_share(ShadowTest* test, const RayScene* scene, const Receivers* r, uint block,
                                 uint light, global const ShadowLight* lights, constant ShadowView* v, uint x,
                                 uint y) {
  global const ShadowLight* l = lights + light;
#if defined(SHADOW_PICK)
  if (l->w != 0) return picked_or_away(scene, r, l, test->picked[block], v);
#elif defined(SHADOW_RAYS)
  if (l->w != 0) return soft_share(scene, r, l, x, y, light, &test->traced, &test->last_blocker);
#endif
  const mask_t reached = may_shade(r, l);
  if (!any_lane(reached)) return (whole)(0);
  const mask_t away = turned_away(scene, r, l, reached, v);
  const whole hidden = hidden_by_test(test, scene, r, light, l, reached & ~away);
  return away ? (whole)(255) : hidden;
}
