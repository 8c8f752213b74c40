// Normals for the light buffer of light_prepass. No lights are read.
//
// normals     out: one for each pixel or sample (kernels/resolve/stored_normals.h). Samples without a surface
//             keep what the walker over pixels stored
// -DNORMALS_…, -DPREPASS_STORED, -DSAMPLES, -DSURFACE_NUMBERS, and what kernels/resolve/resolve.h names
#pragma once

#include "kernels/resolve/stored_normals.h"
#include "kernels/resolve/texel_places.h"

#define OUTPUT_LIST(X) X(global normal_t*, normals) SURFACE_NUMBERS_OUT(X)
DECLARE_OUTPUT;
#define NEEDS_EVERY_PIXEL true

#ifdef PREPASS_STORED
#define FOURTH_CHANNEL(surface) ((surface)->roughness)
#else
#define FOURTH_CHANNEL(surface) REAL(0.0f)
#endif

// fourth: of the texels. covered: lanes with a surface.
static inline void store_normals(global normal_t* to, Real3 n, real fourth, mask_t covered,
                                 const TexelPlaces* places) {
  n = select3(covered, n, real3(REAL(0.0f), REAL(0.0f), REAL(1.0f)));
  fourth = covered ? fourth : REAL(0.0f);
#ifdef NORMAL_CHANNEL_STEPS
#ifdef PREPASS_STORED
  const packed_normal_t packed = with_roughness(packed_normal(n), fourth);
#else
  const packed_normal_t packed = packed_normal(n);
#endif
#elif LANES == 16
  float16 packed[4];
  rows_of_block(packed, n, fourth);
#if SAMPLES == 1
  if (places->count == 16) {
    for (uint i = 0; i < 4; ++i) store_row(packed[i], (global float*)(to + places->at[4 * i]));
    return;
  }
#endif
#else
  const normal_t packed = (float4)(n.x, n.y, n.z, fourth);
#endif
  FOR_TEXELS(t, places)
  to[PLACE_OF_TEXEL(places, t)] = LANE_OF_TEXEL(places, t, normal_t, packed);
}

STORE_RESOLVED {
  const TexelPlaces places = texel_places(where);
  const Real3 normal = shading_normal(resolved->attributes, resolved->surface);
  store_normals(output->normals, normal, FOURTH_CHANNEL(resolved->surface), resolved->covered, &places);
#ifdef SURFACE_NUMBERS
  store_surface_numbers(output->surface_numbers, resolved->attributes->surface_number, resolved->covered,
                        &places);
#endif
}
