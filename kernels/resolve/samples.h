// The samples of a pixel: which surfaces they see, and how much of the pixel each surface has.
//
// A surface here is a triangle, or the background. Each is shaded once a pixel, at the centroid of the
// samples that see it, which lies inside the triangle, as a triangle is convex: attributes at a pixel's
// centre, which the triangle may not cover, would be extrapolated. A depth is linear on the screen, so that
// the mean of the samples' depths is the centroid's. The standard places have their mean in the centre: a
// pixel that one triangle covers is shaded at its centre, as with one sample.
//
// -DSAMPLES        a pixel: 2, 4 or 8, side by side in every image of samples; without, there is nothing here
// -DSAMPLE_PLACES  x and y of each, 1/256 pixel from the pixel's centre, y up
#pragma once

#include "shared/surface_records.h"

#ifdef SAMPLES
// Pixels a side of the squares whose edge pixels' attributes have one origin, whatever the tile's size.
#define EDGE_BLOCK 16u

constant int sample_places[2 * SAMPLES] = {SAMPLE_PLACES};

#define SAMPLE_X(s) ((float)sample_places[2 * (s)] * (1.0f / 256))  // from the centre, pixels
#define SAMPLE_Y(s) ((float)sample_places[2 * (s) + 1] * (1.0f / 256))

// One surface of a pixel.
typedef struct PixelSurface {
  uint triangle;       // or SURFACE_NONE
  float share;         // of the pixel
  float off_x, off_y;  // from the pixel's centre to the centroid, pixels
  float depth;
} PixelSurface;

// The next surface of a pixel, of the samples in `left`, a bit each, from which those that see it are taken.
static inline PixelSurface next_surface(global const uint* triangles, global const float* depths,
                                        uint* left) {
  uint first = 0;
  while (!(*left >> first & 1u)) ++first;
  PixelSurface p = {triangles[first], 0.0f, 0.0f, 0.0f, 0.0f};
  int count = 0, x = 0, y = 0;
  for (uint s = first; s < SAMPLES; ++s) {
    if (!(*left >> s & 1u) || triangles[s] != p.triangle) continue;
    *left &= ~(1u << s);
    ++count, x += sample_places[2 * s], y += sample_places[2 * s + 1];
    p.depth += depths[s];
  }
  const float mean = 1.0f / (float)count;
  p.share = (float)count * (1.0f / SAMPLES);
  p.depth *= mean, p.off_x = (float)x * (mean / 256), p.off_y = (float)y * (mean / 256);
  return p;
}

#define ALL_SAMPLES ((1u << SAMPLES) - 1u)
#endif
