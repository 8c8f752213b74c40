// The surfaces that light passes shade, LANES at a time, of images that store one for each sample. A pixel of
// one surface counts once, at its centre, where the mean of its depths is. At edges every sample counts.
//
// -DSAMPLES, -DSAMPLE_PLACES  kernels/common/sample_places.h; without, a pixel has one sample
#pragma once

#include "kernels/common/image_blocks.h"
#include "kernels/common/sample_places.h"
#include "shared/real.h"

// A sample, or all of a pixel.
typedef struct StoredSample {
  float x, y, depth;  // place in pixels; reversed depth, 0: background
  float share;        // of the pixel
  uint image;         // whose surface it has, in images of samples
  bool next;          // not the first of its pixel
} StoredSample;

// edges: a mask for every 16 pixels; null: every pixel is at an edge.
static inline bool at_edge(global const ushort* edges, size_t pixel) {
  return !edges || (edges[pixel / 16] >> (pixel % 16) & 1);
}

static inline StoredSample stored_sample(global const float* depths, uint x, uint y, uint width, uint s,
                                         bool edge) {
  const size_t image = ((size_t)y * width + x) * SAMPLES;
  StoredSample at = {(float)x + 0.5f, (float)y + 0.5f, 0.0f, 1.0f, (uint)image, s > 0};
  if (edge) {
    at.x += SAMPLE_X(s);
    at.y += SAMPLE_Y(s);
    at.depth = depths[image + s];
    at.share = 1.0f / SAMPLES;
    at.image += s;
  } else {
    for (uint k = 0; k < SAMPLES; ++k) at.depth += depths[image + k];
    at.depth *= 1.0f / SAMPLES;
  }
  return at;
}

// How many places of an image of samples store what is shaded once.
#define PLACES_OF(share) ((share) == 1.0f ? SAMPLES : 1)

#if LANES == 1
typedef StoredSample StoredBatch;
#define IMAGE_OF(b, i) (b)->image
#else
// With one sample, a block of 4 x 4 pixels; with several, 16 samples in the order of a tile's rows. Lanes
// without one are background.
typedef struct StoredBatch {
  real x, y, depth;
  uint16 image;
  uint lanes;    // with one, as a mask
  bool in_rows;  // images: each four lanes' follow one another
#if SAMPLES > 1
  float share[16];
  bool next[16];
#endif
} StoredBatch;
#define IMAGE_OF(b, i) (((const uint*)&(b)->image)[i])
#if SAMPLES > 1
#define SHARE_OF(b, i) (b)->share[i]
#define IS_NEXT(b, i) (b)->next[i]
#else
#define SHARE_OF(b, i) 1.0f
#define IS_NEXT(b, i) false
#endif

typedef struct StoredWalk {
  uint x_begin, x_end, y_end, x, y, s;
} StoredWalk;

static inline void step_x(StoredWalk* walk, uint pixels) {
  walk->x += pixels;
  if (walk->x >= walk->x_end) {
    walk->x = walk->x_begin;
    walk->y += pixels;
  }
}

#if SAMPLES == 1
// Takes the next batch of a tile. Returns false if there is none.
static inline bool next_batch(StoredBatch* b, StoredWalk* walk, global const float* depths,
                              global const ushort* edges, uint width, uint height) {
  const uint x = walk->x, y = walk->y;
  if (y >= walk->y_end) return false;
  const uint16 column = as_uint16(LANE_INDEX & 3) + x, row = as_uint16(LANE_INDEX >> 2) + y;
  b->image = min(row, height - 1) * width + min(column, width - 1);
  b->lanes = mask_bits((column < width) & (row < height));
  b->in_rows = b->lanes == 0xffffu;
  b->depth = as_float16(load_block((global const uint*)depths, x, y, width, height));
  b->x = (float)x + 0.5f + convert_float16(LANE_INDEX & 3);
  b->y = (float)y + 0.5f + convert_float16(LANE_INDEX >> 2);
  step_x(walk, 4);
  return true;
}
#else
static inline bool next_batch(StoredBatch* b, StoredWalk* walk, global const float* depths,
                              global const ushort* edges, uint width, uint height) {
  float x[16] = {0}, y[16] = {0}, depth[16] = {0};
  uint image[16] = {0}, count = 0;
  for (; count < 16 && walk->y < walk->y_end; ++count) {
    const bool edge = at_edge(edges, (size_t)walk->y * width + walk->x);
    const StoredSample at = stored_sample(depths, walk->x, walk->y, width, walk->s, edge);
    x[count] = at.x;
    y[count] = at.y;
    depth[count] = at.depth;
    b->share[count] = at.share;
    image[count] = at.image;
    b->next[count] = at.next;
    walk->s = edge ? (walk->s + 1) % SAMPLES : 0;
    if (walk->s == 0) step_x(walk, 1);
  }
  b->x = vload16(0, x);
  b->y = vload16(0, y);
  b->depth = vload16(0, depth);
  b->image = vload16(0, image);
  b->lanes = first_lanes(count);
  b->in_rows = false;
  return count > 0;
}
#endif
#endif
