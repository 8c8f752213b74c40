// Normals for the light buffer of light_prepass. No lights are read.
//
// normals     out: one for each pixel or sample (kernels/resolve/stored_normals.h). Samples without a surface
//             keep what the walker over pixels stored
// -DNORMALS_…, -DPREPASS_STORED, -DSAMPLES, -DSURFACE_NUMBERS, and what kernels/resolve/resolve.h names
#pragma once

#include "kernels/resolve/stored_normals.h"
#include "kernels/resolve/texel_places.h"

typedef struct Output {
  float4 background;
  global float* image;
  global normal_t* normals;
  SURFACE_NUMBERS_MEMBER
} Output;
#define OUTPUT_ARGUMENTS global normal_t* normals SURFACE_NUMBERS_OUT
#define GIVEN_OUTPUT \
  { .normals = normals GIVEN_SURFACE_NUMBERS_OUT }
#define READS_DEPTH(output) false
#define SHOWS_LIGHT(output) false
#define NEEDS_EVERY_PIXEL true

LIGHT_OF { return real3(REAL(0.0f), REAL(0.0f), REAL(0.0f)); }

#ifdef PREPASS_STORED
#define FOURTH_CHANNEL(surface) ((surface)->roughness)
#else
#define FOURTH_CHANNEL(surface) REAL(0.0f)
#endif

// fourth: of the texels. covered: lanes with a surface.
static inline void store_normals(global normal_t* to, Real3 n, real fourth, mask_t covered,
                                 const TexelPlaces* places) {
  const real none = 0.0f;
  n = real3(covered ? n.x : none, covered ? n.y : none, covered ? n.z : REAL(1.0f));
  fourth = covered ? fourth : none;
#ifdef NORMAL_CHANNEL_STEPS
#ifdef PREPASS_STORED
  const packed_normal_t packed = with_roughness(packed_normal(n), fourth);
#else
  const packed_normal_t packed = packed_normal(n);
#endif
#if LANES == 16
  for (uint i = 0; i < places->count; ++i) to[places->at[i]] = ((const uint*)&packed)[places->lane[i]];
#endif
#elif LANES == 16
  float16 rows[4];
  rows_of_block(rows, n, fourth);
#if SAMPLES == 1
  if (places->count == 16) {
    for (uint i = 0; i < 4; ++i) store_row(rows[i], (global float*)(to + places->at[4 * i]));
    return;
  }
#endif
  for (uint i = 0; i < places->count; ++i) to[places->at[i]] = ((const float4*)rows)[places->lane[i]];
#else
  const normal_t packed = (float4)(n.x, n.y, n.z, fourth);
#endif
#if LANES == 1
  for (uint s = 0; s < SAMPLES; ++s)
    if (places->samples >> s & 1u) to[places->pixel * SAMPLES + s] = packed;
#endif
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
