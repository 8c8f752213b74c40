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

// Samples' share of the pixel.
static inline float share_of(uint samples) { return (float)popcount(samples) * (1.0f / SAMPLES); }
#endif
