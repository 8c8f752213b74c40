// Where the samples of a pixel lie.
//
// -DSAMPLES        a pixel: 2, 4 or 8; without, one in its centre
// -DSAMPLE_PLACES  x and y of each, 1/256 pixel from the pixel's centre, y up
#pragma once

#ifndef SAMPLES
#define SAMPLES 1
#define SAMPLE_PLACES 0, 0
#endif

#define ALL_SAMPLES ((1u << SAMPLES) - 1u)  // a bit each

constant int sample_places[2 * SAMPLES] = {SAMPLE_PLACES};

// The side of a sample's share of a pixel, as a square, pixels: 1 / sqrt(SAMPLES).
#if SAMPLES == 2
#define SAMPLE_SIDE 0.70710678f
#elif SAMPLES == 4
#define SAMPLE_SIDE 0.5f
#elif SAMPLES == 8
#define SAMPLE_SIDE 0.35355339f
#else
#define SAMPLE_SIDE 1.0f
#endif

#define SAMPLE_UNITS_X(s) sample_places[2 * (s)]
#define SAMPLE_UNITS_Y(s) sample_places[2 * (s) + 1]
#define SAMPLE_X(s) ((float)SAMPLE_UNITS_X(s) * (1.0f / 256))  // from the centre, pixels
#define SAMPLE_Y(s) ((float)SAMPLE_UNITS_Y(s) * (1.0f / 256))

// The most that a x + b y gains from a pixel's centre to one of its samples.
static inline int max_gain(int a, int b) {
  int most = a * SAMPLE_UNITS_X(0) + b * SAMPLE_UNITS_Y(0);
#pragma unroll
  for (int s = 1; s < SAMPLES; ++s) most = max(most, a * SAMPLE_UNITS_X(s) + b * SAMPLE_UNITS_Y(s));
  return most;
}
