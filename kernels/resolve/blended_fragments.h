// The fragments of blended surfaces, in drawing order: what kernels that lay them over the image, and those
// that list them, go through alike.
//
// -DSAMPLES, -DSAMPLE_PLACES  (kernels/resolve/samples.h) depths are those of samples. A blended triangle has
// a fragment where it covers a pixel's centre, and hides what the samples behind it see: its alpha counts by
// their share of the pixel. Its depth is compared at each sample's place.
#pragma once

#include "kernels/raster/raster_blocks.h"
#include "kernels/resolve/samples.h"
#include "shared/real.h"
#if SAMPLES > 1
#define SHARE , real* share
#define SHARE_TO(to) , &to
typedef global const float* OpaqueDepth;
#define OPAQUE_DEPTH(depths, pixel) ((depths) + (pixel)*SAMPLES)
#else
#define SHARE
#define SHARE_TO(to)
typedef float OpaqueDepth;
#define OPAQUE_DEPTH(depths, pixel) ((depths)[pixel])
#endif

#if LANES == 16
#include "kernels/common/image_blocks.h"

// Lanes of a block of 4 x 4 pixels, (x, y) of the image and (bx, by) of the tile, that show the record in
// front of the opaque surfaces, and its depth there. share: with -DSAMPLES, of the samples behind it.
static inline mask_t fragments_in_block(const TileRecord* r, int bx, int by, uint x, uint y,
                                        global const float* depths, uint width, uint height,
                                        real* depth SHARE) {
  const int16 across = LANE_INDEX & 3, up = LANE_INDEX >> 2;
  const int16 inside = (across < (int16)((int)(width - x))) & (up < (int16)((int)(height - y)));
  const mask_t covered = inside & covered_pixels(r, bx, by, across, up);
  if (!any_lane(covered)) return covered;
  *depth = depth_at(r, bx, by, convert_float16(across), convert_float16(up));
#if SAMPLES > 1
  *share = 0.0f;
  for (uint s = 0; s < SAMPLES; ++s) {
    real opaque = 0.0f;
    for (uint left = mask_bits(covered); left != 0; left &= left - 1) {
      const uint i = lowest_bit(left);
      ((float*)&opaque)[i] = depths[((size_t)(y + i / 4) * width + x + i % 4) * SAMPLES + s];
    }
    const real here =
        depth_at(r, bx, by, convert_float16(across) + SAMPLE_X(s), convert_float16(up) + SAMPLE_Y(s));
    *share += here >= opaque ? REAL(1.0f / SAMPLES) : REAL(0.0f);
  }
  return covered & (*share > REAL(0.0f)) & (*depth >= REAL(FLT_MIN));
#else
  const real opaque = as_float16(load_block((global const uint*)depths, x, y, width, height));
  return covered & (*depth >= opaque) & (*depth >= REAL(FLT_MIN));
#endif
}

// Fragments of each pixel of a tile so far, block after block.
typedef struct FragmentCounts {
  ushort of[RASTER_TILE * RASTER_TILE];
} FragmentCounts;

// The layers of these lanes' fragments: each is the pixel's next one.
static inline whole next_layers(FragmentCounts* counts, int bx, int by, mask_t shown) {
  const size_t block = (size_t)(by / 4 * (RASTER_TILE / 4) + bx / 4);
  const whole layer = convert_int16(vload16(block, counts->of));
  vstore16(convert_ushort16(layer - shown), block, counts->of);  // -1 where shown
  return layer;
}
#else
// Tests one pixel, (dx, dy) of the block. opaque: the pixel's depth, or those of its samples.
static inline bool is_fragment(const TileRecord* r, int bx, int by, int dx, int dy, OpaqueDepth opaque,
                               float* depth SHARE) {
  if (!covered_pixels(r, bx, by, dx, dy)) return false;
  *depth = depth_at(r, bx, by, (float)dx, (float)dy);
#if SAMPLES > 1
  *share = 0.0f;
  for (uint s = 0; s < SAMPLES; ++s) {
    const float here = depth_at(r, bx, by, (float)dx + SAMPLE_X(s), (float)dy + SAMPLE_Y(s));
    *share += here >= opaque[s] ? 1.0f / SAMPLES : 0.0f;
  }
  return *share > 0.0f && *depth >= FLT_MIN;
#else
  return *depth >= opaque && *depth >= FLT_MIN;
#endif
}
#endif
