// Options and layout that both forms of depth_bounds share. The finer bounds read a tile's depths a second
// time.
//
// Bounds are BOUND_PLANES floats a tile (shared/cull_settings.h): for each bin, plane after plane of BIN_SIZE
// slots. Distances are metres, each widened by rounding; (FAR_AWAY, -FAR_AWAY) where a tile holds no surface.
//
// -DTILE (8, 16, 32, 64)  -DSAMPLES a pixel, side by side  -DSTANDARD_DEPTH  -DDEPTH_MODE
// -DBLEND: also, in planes of their own, from the near plane to where a blended surface can be seen
#pragma once

#ifndef TILE
#define TILE 16
#endif
#ifndef SAMPLES
#define SAMPLES 1
#endif
#ifndef DEPTH_MODE
#define DEPTH_MODE 1
#endif
#include "kernels/culling/depth_interval.h"

#define ROW (TILE * SAMPLES)  // values in a tile's row
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED || DEPTH_MODE == DEPTH_MASK32
#define SECOND_LOOK
#endif

static inline void put_bounds(global float* bounds, uint planes, uint plane, uint tx, uint ty, float value,
                              constant CullParams* p) {
  const uint bin = ty / BIN_TILES * p->bins_x + tx / BIN_TILES;
  bounds[(bin * planes + plane) * BIN_SIZE + slot_of_tile(tx % BIN_TILES, ty % BIN_TILES)] = value;
}
