// Where the texels of LANES surfaces go, in images that store one for each sample, those of a pixel side by
// side: a surface's texel is stored for every sample that sees it.
//
// -DSAMPLES        kernels/common/sample_places.h; without, a pixel has one texel
// -DSAMPLES_APART  with -DOUTPUT_SUMS: the light buffer has sums for every sample, not only for those of
// pixels
//                  at edges
// -DSURFACE_NUMBERS  kernels/resolve/surface_numbers.h
#pragma once

#include "kernels/common/sample_places.h"
#include "kernels/resolve/surface_numbers.h"
#include "shared/real.h"

// Samples of a pixel with one surface that have a value of their own, as a mask.
#if defined(OUTPUT_SUMS) && !defined(SAMPLES_APART)
#define PIXEL_SAMPLES 1u
#else
#define PIXEL_SAMPLES ALL_SAMPLES
#endif

#if LANES == 16
typedef struct TexelPlaces {
  uint count;
  uint lane[16 * SAMPLES], at[16 * SAMPLES];  // of each texel: the lane of its surface, and its place
} TexelPlaces;
#define FOR_TEXELS(t, places) for (uint t = 0; t < (places)->count; ++t)
#define PLACE_OF_TEXEL(places, t) (places)->at[t]
#define LANE_OF_TEXEL(places, t, type, values) ((const type*)&(values))[(places)->lane[t]]

// samples: those of the pixel that see the lane's surface, as a mask.
static inline void add_texels(TexelPlaces* to, uint lane, uint pixel, uint samples) {
  for (; samples != 0; samples &= samples - 1) {
    to->lane[to->count] = lane;
    to->at[to->count++] = pixel * SAMPLES + lowest_bit(samples);
  }
}

// All samples of a block of 4 x 4 pixels from (x, y) on, a lane each.
static inline TexelPlaces texels_of_block(uint x, uint y, uint width, uint height) {
  TexelPlaces to;
  to.count = 0;
  const uint columns = min(width - x, 4u), lines = min(height - y, 4u);
  for (uint line = 0; line < lines; ++line)
    for (uint i = 0; i < columns; ++i) add_texels(&to, 4 * line + i, (y + line) * width + x + i, ALL_SAMPLES);
  return to;
}
#else
typedef struct TexelPlaces {
  size_t pixel;
  uint samples;
} TexelPlaces;
#define FOR_TEXELS(t, places)        \
  for (uint t = 0; t < SAMPLES; ++t) \
    if ((places)->samples >> t & 1u)
#define PLACE_OF_TEXEL(places, t) (places)->pixel* SAMPLES + t
#define LANE_OF_TEXEL(places, t, type, value) (value)
#endif

// For kernels with SURFACE_NUMBERS_OUT (kernels/resolve/surface_numbers.h).
#ifdef SURFACE_NUMBERS
static inline void store_surface_numbers(global surface_number_t* to, whole numbers, mask_t covered,
                                         const TexelPlaces* places) {
  const whole stored = covered ? numbers : WHOLE(0);
  FOR_TEXELS(t, places)
  to[PLACE_OF_TEXEL(places, t)] = (surface_number_t)LANE_OF_TEXEL(places, t, int, stored);
}
#endif
