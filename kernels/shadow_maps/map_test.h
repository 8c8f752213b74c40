// How a light's shadow is found at LANES pixels by its shadow map.
#pragma once

#include "kernels/shadows/receivers.h"

#define SHADOW_TEST_ARGUMENTS SHADOW_MAPS_ARGUMENTS,
#define SHADOW_TEST SHADOW_MAPS
typedef ShadowMaps ShadowTest;

// The share of the texels around the lanes' points that see something nearer, in 255ths.
static inline whole hidden_by_test(ShadowTest* maps, const RayScene* scene, const Receivers* r, uint light,
                                   global const ShadowLight* l, mask_t active) {
  const float share = 255.0f / (SHADOW_TAPS * SHADOW_TAPS);
  return TO_WHOLE(TO_REAL(shadow_taps(maps, light, &r->for_maps, active)) * share + 0.5f);
}

#define rays_of_test(test) 0
