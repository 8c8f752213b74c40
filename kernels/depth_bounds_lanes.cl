// Depth bounds of every tile, for CPUs: one work-item reads the rows of one tile.
//
// depth   width x height floats, reversed (near 1, far 0, nothing there 0), row 0 at the bottom
// opaque  a float2 a tile: least and greatest distance of its surfaces in metres, each widened by rounding;
//         (FAR_AWAY, -FAR_AWAY) where it holds none
// blend   with -DBLEND: near plane to the greatest distance that a blended surface can be seen at
// -DTILE  tile size in pixels (default 16; 8, 16, 32 or 64)
//
// The interval of min/max depth per tile: Harada, McKee, Yang, "Forward+" (Eurographics 2012).
#include "kernels/common/depth_interval.h"

#ifndef TILE
#define TILE 16
#endif
#if TILE == 8
typedef uint8 row_t;
#define LOAD_ROW(p) vload8(0, p)
#else
typedef uint16 row_t;
#define LOAD_ROW(p) vload16(0, p)
#endif
#define ROW_LANES (TILE == 8 ? 8 : 16)

kernel void depth_bounds_lanes(global const uint* depth, global float2* opaque, global float2* blend,
                               constant ViewParams* view) {
  const uint tile = get_global_id(0);
  const uint x0 = tile % view->tiles_x * TILE, y0 = tile / view->tiles_x * TILE;
  const uint x1 = min(x0 + TILE, view->width), y1 = min(y0 + TILE, view->height);
  // Unsigned order of the bits is the order of depths in [0, 1]; bits - 1 sends "nothing there" (0) to the top, so
  // the minimum leaves it out at no cost.
  row_t low = (row_t)(0xffffffffu), high = (row_t)(0u), lowest = (row_t)(0xffffffffu);
  uint low1 = 0xffffffffu, high1 = 0u, lowest1 = 0xffffffffu;
  for (uint y = y0; y < y1; ++y) {
    global const uint* row = depth + (size_t)y * view->width;
    uint x = x0;
    for (; x + ROW_LANES <= x1; x += ROW_LANES) {
      row_t bits = LOAD_ROW(row + x);
      low = min(low, bits - 1u);
      high = max(high, bits);
#ifdef BLEND
      lowest = min(lowest, bits);
#endif
    }
    for (; x < x1; ++x) {
      low1 = min(low1, row[x] - 1u);
      high1 = max(high1, row[x]);
      lowest1 = min(lowest1, row[x]);
    }
  }
  uint lows[ROW_LANES], highs[ROW_LANES], lowests[ROW_LANES];
#if TILE == 8
  vstore8(low, 0, lows), vstore8(high, 0, highs), vstore8(lowest, 0, lowests);
#else
  vstore16(low, 0, lows), vstore16(high, 0, highs), vstore16(lowest, 0, lowests);
#endif
  for (int i = 0; i < ROW_LANES; ++i) {
    low1 = min(low1, lows[i]);
    high1 = max(high1, highs[i]);
    lowest1 = min(lowest1, lowests[i]);
  }
  opaque[tile] = opaque_interval(low1 + 1u, high1, view);
#ifdef BLEND
  blend[tile] = blend_interval(lowest1, high1, view);
#endif
}
