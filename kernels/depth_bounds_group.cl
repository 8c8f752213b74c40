// Depth bounds of every tile, for GPUs: one work-group of GROUP items reads one tile. The same contract, arguments
// and bytes as depth_bounds_lanes.cl.
// -DTILE   tile size in pixels (default 16)
// -DGROUP  items a group, a power of two (default 64)
#include "kernels/common/depth_interval.h"

#ifndef TILE
#define TILE 16
#endif
#ifndef GROUP
#define GROUP 64
#endif

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void depth_bounds_group(
    global const uint* depth, global float2* opaque, global float2* blend, constant ViewParams* view) {
  local uint lows[GROUP], highs[GROUP], lowests[GROUP];
  const uint tile = get_group_id(0), item = get_local_id(0);
  const uint x0 = tile % view->tiles_x * TILE, y0 = tile / view->tiles_x * TILE;
  uint low = 0xffffffffu, high = 0u, lowest = 0xffffffffu;
  for (uint i = item; i < TILE * TILE; i += GROUP) {
    const uint x = x0 + i % TILE, y = y0 + i / TILE;
    if (x < view->width && y < view->height) {
      const uint bits = depth[(size_t)y * view->width + x];
      low = min(low, bits - 1u);
      high = max(high, bits);
      lowest = min(lowest, bits);
    }
  }
  lows[item] = low, highs[item] = high, lowests[item] = lowest;
  for (uint step = GROUP / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < step) {
      lows[item] = min(lows[item], lows[item + step]);
      highs[item] = max(highs[item], highs[item + step]);
      lowests[item] = min(lowests[item], lowests[item + step]);
    }
  }
  if (item == 0) {
    opaque[tile] = opaque_interval(lows[0] + 1u, highs[0], view);
#ifdef BLEND
    blend[tile] = blend_interval(lowests[0], highs[0], view);
#endif
  }
}
