// The samples of a tile that are shaded, of images that store a surface a sample: a pixel of one surface
// counts once, at its centre, where the mean of its depths is; of others every sample counts.
//
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h
#pragma once

#include "kernels/common/sample_places.h"
#include "shared/real.h"

// A sample, or all of a pixel.
typedef struct StoredSample {
  float x, y, depth;  // place in pixels; reversed depth, 0: background
  float share;        // of the pixel
  uint image;         // whose surface it has, in images of samples
} StoredSample;

// edges: a bit a pixel, 16 in a value; null: every pixel is at an edge.
static inline bool at_edge(global const ushort* edges, size_t pixel) {
  return !edges || (edges[pixel / 16] >> (pixel % 16) & 1);
}

static inline StoredSample stored_sample(global const float* depths, uint x, uint y, uint width, uint s) {
  const size_t image = ((size_t)y * width + x) * SAMPLES + s;
  const StoredSample at = {(float)x + 0.5f + SAMPLE_X(s), (float)y + 0.5f + SAMPLE_Y(s), depths[image],
                           1.0f / SAMPLES, (uint)image};
  return at;
}

static inline StoredSample whole_pixel(global const float* depths, uint x, uint y, uint width) {
  const size_t image = ((size_t)y * width + x) * SAMPLES;
  float sum = 0;
  for (uint s = 0; s < SAMPLES; ++s) sum += depths[image + s];
  const StoredSample at = {(float)x + 0.5f, (float)y + 0.5f, sum * (1.0f / SAMPLES), 1.0f, (uint)image};
  return at;
}

#if LANES == 16
// 16 of them, in the order of a tile's rows.
typedef struct SampleBatch {
  float x[16], y[16], depth[16], share[16];
  uint image[16];
  bool next[16];  // not the first of its pixel
  uint count;     // past it, lanes are background
} SampleBatch;

typedef struct SampleWalk {
  uint x_begin, x_end, y_end, x, y, s;
} SampleWalk;

static inline void next_batch(SampleBatch* b, SampleWalk* walk, global const float* depths,
                              global const ushort* edges, uint width) {
  b->count = 0;
  for (uint i = 0; i < 16; ++i) b->depth[i] = 0, b->x[i] = b->y[i] = 0, b->image[i] = 0;
  while (b->count < 16 && walk->y < walk->y_end) {
    const bool edge = at_edge(edges, (size_t)walk->y * width + walk->x);
    const StoredSample at = edge ? stored_sample(depths, walk->x, walk->y, width, walk->s)
                                 : whole_pixel(depths, walk->x, walk->y, width);
    const uint i = b->count++;
    b->x[i] = at.x, b->y[i] = at.y, b->depth[i] = at.depth, b->share[i] = at.share, b->image[i] = at.image;
    b->next[i] = walk->s > 0;
    walk->s = edge ? (walk->s + 1) % SAMPLES : 0;
    if (walk->s == 0) ++walk->x;
    if (walk->x == walk->x_end) walk->x = walk->x_begin, ++walk->y;
  }
}
#endif
