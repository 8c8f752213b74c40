// The pixels whose samples are several surfaces, of images that store a surface a sample. Lauritzen,
// "Deferred Rendering for Current and Future Rendering Pipelines" (SIGGRAPH 2010), compares samples within
// thresholds. Here they are one surface only if they store the same bits, as of a triangle that covers the
// pixel and was shaded once for it, and if their depths lie in a plane. What is called an edge without need
// costs time and no accuracy.
//
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h; those of a pixel follow one another
#pragma once

#include "kernels/common/sample_places.h"
#include "kernels/resolve/surface_numbers.h"

static inline bool stores_one(global const uint* image, size_t pixel) {
  if (!image) return true;
  image += pixel * SAMPLES * WORDS;
  for (uint i = WORDS; i < SAMPLES * WORDS; ++i)
    if (image[i] != image[i % WORDS]) return false;
  return true;
}

// Two depths always lie in a plane: they count as one surface if they are nearly the same.
static inline bool in_plane(global const float* depth) {
  float mean = 0, most = 0, along_x = 0, along_y = 0, xx = 0, xy = 0, yy = 0;
  for (uint s = 0; s < SAMPLES; ++s) {
    mean += depth[s] * (1.0f / SAMPLES);
    most = fmax(most, depth[s]);
  }
  for (uint s = 0; s < SAMPLES; ++s) {
    const float x = SAMPLE_X(s), y = SAMPLE_Y(s), d = depth[s] - mean;
    along_x += x * d;
    along_y += y * d;
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const float determinant = xx * yy - xy * xy;
  const bool plane = SAMPLES > 2;
  const float by_x = plane ? (along_x * yy - along_y * xy) / determinant : 0.0f;
  const float by_y = plane ? (along_y * xx - along_x * xy) / determinant : 0.0f;
  const float slack = most * (plane ? 0x1p-18f : 0x1p-10f);
  for (uint s = 0; s < SAMPLES; ++s)
    if (fabs(mean + by_x * SAMPLE_X(s) + by_y * SAMPLE_Y(s) - depth[s]) > slack) return false;
  return true;
}

#ifdef NUMBER_BITS
static inline bool has_one_number(global const surface_number_t* numbers) {
  for (uint s = 1; s < SAMPLES; ++s)
    if (numbers[s] != numbers[0]) return false;
  return true;
}
#else
#define has_one_number(numbers) true
#endif

#define SURFACE_ARGUMENTS                                                                                   \
  global const uint *first, global const uint *second, global const uint *third, global const uint *fourth, \
      SURFACE_NUMBER_ARGUMENTS global const float *depths
#ifdef NUMBER_BITS
#define GIVEN_SURFACE_NUMBERS surface_numbers, last_number,
#else
#define GIVEN_SURFACE_NUMBERS
#endif

static inline bool has_one_surface(size_t at, SURFACE_ARGUMENTS) {
  return stores_one(first, at) && stores_one(second, at) && stores_one(third, at) && stores_one(fourth, at) &&
         has_one_number(surface_numbers + at * SAMPLES) && in_plane(depths + at * SAMPLES);
}
#define HAS_ONE_SURFACE(at) has_one_surface(at, first, second, third, fourth, GIVEN_SURFACE_NUMBERS depths)
