// The samples of a pixel: which surfaces they see, and how much of the pixel each surface has.
//
// A surface here is a triangle, or the background. Each is shaded once a pixel, at the centroid of the
// samples that see it, which lies inside the triangle, as a triangle is convex: attributes at a pixel's
// centre, which the triangle may not cover, would be extrapolated. A depth is linear on the screen, so that
// the mean of the samples' depths is the centroid's. The standard places have their mean in the centre: a
// pixel that one triangle covers is shaded at its centre, as with one sample.
//
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h; side by side in every image of samples.
// Without, or with one, there is nothing here
#pragma once

#include "kernels/common/sample_places.h"
#include "shared/lanes.h"
#include "shared/surface_records.h"

#if SAMPLES > 1

// Pixels a side of the squares whose edge pixels' attributes have one origin, whatever the tile's size.
#define EDGE_BLOCK 16u

// One surface of a pixel.
typedef struct PixelSurface {
  uint triangle;       // or SURFACE_NONE
  uint samples;        // that see it, a bit each
  float off_x, off_y;  // from the pixel's centre to the centroid, pixels
  float depth;
} PixelSurface;

// Samples' share of the pixel.
static inline float share_of(uint samples) { return (float)popcount(samples) * (1.0f / SAMPLES); }

// The next surface of a pixel, of the samples in `left`, a bit each, from which those that see it are taken.
static inline PixelSurface next_surface(global const uint* triangles, global const float* depths,
                                        uint* left) {
  PixelSurface p = {triangles[lowest_bit(*left)], 0, 0.0f, 0.0f, 0.0f};
  int x = 0, y = 0;
  // Without branches, which would be taken at random.
#pragma unroll
  for (uint s = 0; s < SAMPLES; ++s) {
    const bool here = triangles[s] == p.triangle;
    p.samples |= here ? 1u << s : 0u;
    x += here ? SAMPLE_UNITS_X(s) : 0;
    y += here ? SAMPLE_UNITS_Y(s) : 0;
    p.depth += here ? depths[s] : 0.0f;
  }
  *left &= ~p.samples;
  const int count = (int)popcount(p.samples);
  const float mean = 1.0f / (float)count;
  p.depth *= mean;
  p.off_x = (float)x * (mean / 256);
  p.off_y = (float)y * (mean / 256);
  return p;
}
#endif
