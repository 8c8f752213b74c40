// Fine step of light culling, for GPUs: one work-group of GROUP items takes a tile, and walks its bin's candidates
// GROUP at a time. The same contract and bytes as cull_tiles_lanes.cl.
// -DGROUP  items a group, a power of two (default 64)
#include "kernels/common/bin.h"
#include "kernels/common/append.h"

#ifndef INDEX
#define INDEX uint
#endif

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cull_tiles_group(
    global const uint2* bins, global const float* candidates, uint stride, global const float4* cones,
    global const float2* intervals, global uint2* cells, global INDEX* indices, uint index_capacity,
    constant ViewParams* view) {
  local uint scratch[2 * GROUP];
  const uint tile = get_group_id(0), item = get_local_id(0);
  const uint tx = tile % view->tiles_x, ty = tile / view->tiles_x;
  const uint bin = ty / BIN_TILES * view->bins_x + tx / BIN_TILES;
  const uint begin = bins[bin].x, end = begin + bins[bin].y;
  if ((ulong)begin + bins[bin].y > stride) return;  // the whole group leaves: no barrier is missed
  const Cell cell = tile_cell(tx, ty, intervals[tile], view);
  uint n = 0;
#ifndef COUNT
  if ((ulong)cells[tile].x + cells[tile].y > index_capacity) return;
  global INDEX* list = indices + cells[tile].x;
#endif
  for (uint base = begin; base < end; base += GROUP) {
    const uint i = base + item;
    uint light = 0;
    bool keep = false;
    if (i < end && cell.near <= cell.far) {
      const float x = candidates[i], y = candidates[(size_t)stride + i], d = candidates[2 * (size_t)stride + i];
      light = as_uint(candidates[4 * (size_t)stride + i]);
      keep = sphere_may_touch(x, y, d, candidates[3 * (size_t)stride + i], &cell);
#ifdef SPOTS
      keep = keep && cone_may_touch(x, y, d, cones[light], &cell);
#endif
    }
    const uint2 place = append_place(keep, scratch);
#ifndef COUNT
    if (keep) list[n + place.x] = (INDEX)light;
#endif
    n += place.y;
  }
#ifdef COUNT
  if (item == 0) cells[tile].y = n;
#endif
}
