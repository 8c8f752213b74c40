// Bins of tiles: their cell, and the records of the lights that may touch them.
#pragma once

#include "kernels/common/light_cell_tests.h"

static inline Cell tile_cell(uint tile_x, uint tile_y, float2 interval, constant ViewParams* view) {
  const uint x = tile_x * view->tile_size, y = tile_y * view->tile_size;
  return make_cell(view, x, y, min(x + view->tile_size, view->width), min(y + view->tile_size, view->height), interval);
}

// The union of the intervals of the bin's tiles that hold anything.
static inline Cell bin_cell(uint bin, global const float2* intervals, constant ViewParams* view) {
  const uint tx0 = bin % view->bins_x * BIN_TILES, ty0 = bin / view->bins_x * BIN_TILES;
  const uint tx1 = min(tx0 + BIN_TILES, view->tiles_x), ty1 = min(ty0 + BIN_TILES, view->tiles_y);
  float2 all = (float2)(FAR_AWAY, -FAR_AWAY);
  for (uint ty = ty0; ty < ty1; ++ty) {
    for (uint tx = tx0; tx < tx1; ++tx) {
      const float2 interval = intervals[ty * view->tiles_x + tx];
      all.x = min(all.x, interval.x), all.y = max(all.y, interval.y);
    }
  }
  const uint size = view->tile_size;
  return make_cell(view, tx0 * size, ty0 * size, min(tx1 * size, view->width), min(ty1 * size, view->height), all);
}

static inline void put_candidate(global float* candidates, uint stride, uint at, global const float* spheres,
                                 uint light_stride, uint light) {
  const float x = spheres[light], y = spheres[light_stride + light];
  const float d = spheres[2 * (size_t)light_stride + light], radius = spheres[3 * (size_t)light_stride + light];
  candidates[at] = x;
  candidates[(size_t)stride + at] = y;
  candidates[2 * (size_t)stride + at] = d;
  // The same expression as inflated(), one lane wide.
  candidates[3 * (size_t)stride + at] = radius + SLACK * (fabs(x) + fabs(y) + fabs(d) + radius);
  candidates[4 * (size_t)stride + at] = as_float(light);
}

#ifdef SPOTS
// Clears the bits of the lights from `base` on whose cones miss the cell.
static inline uint drop_cones(uint bits, uint base, global const float* spheres, uint stride,
                              global const float4* cones, const Cell* cell) {
  uint kept = bits;
  for (uint left = bits; left; left &= left - 1) {
    const uint lane = lowest_bit(left), light = base + lane;
    if (!cone_may_touch(spheres[light], spheres[stride + light], spheres[2 * (size_t)stride + light],
                            cones[light], cell)) {
      kept &= ~(1u << lane);
    }
  }
  return kept;
}
#endif
