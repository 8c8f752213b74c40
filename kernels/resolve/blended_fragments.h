// The fragments of blended surfaces, in drawing order: what kernels that lay them over the image, and those
// that list them, go through alike.
#pragma once

#include "kernels/raster/raster_blocks.h"
#include "shared/real.h"

#if LANES == 16
#include "kernels/common/image_blocks.h"

// Lanes of a block of 4 x 4 pixels, (x, y) of the image and (bx, by) of the tile, that show the record in
// front of the opaque surfaces, and its depth there.
static inline mask_t fragments_in_block(const TileRecord* r, int bx, int by, uint x, uint y,
                                        global const float* depths, uint width, uint height, real* depth) {
  const int16 across = LANE_INDEX & 3, up = LANE_INDEX >> 2;
  const int16 inside = (across < (int16)((int)(width - x))) & (up < (int16)((int)(height - y)));
  const mask_t covered = inside & covered_pixels(r, bx, by, across, up);
  if (!any_lane(covered)) return covered;
  *depth = depth_at(r, bx, by, convert_float16(across), convert_float16(up));
  const real opaque = as_float16(load_block((global const uint*)depths, x, y, width, height));
  return covered & (*depth >= opaque) & (*depth >= REAL(FLT_MIN));
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
// Of one pixel, (dx, dy) of the block.
static inline bool is_fragment(const TileRecord* r, int bx, int by, int dx, int dy, float opaque,
                               float* depth) {
  if (!covered_pixels(r, bx, by, dx, dy)) return false;
  *depth = depth_at(r, bx, by, (float)dx, (float)dy);
  return *depth >= opaque && *depth >= FLT_MIN;
}
#endif
