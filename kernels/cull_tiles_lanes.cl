// Fine step of light culling, for CPUs: which candidates of its bin may touch each tile. One work-item takes a bin,
// and for each of its tiles walks the bin's candidates in order, LANES at a time: lists come out sorted.
//
// bins, candidates  as cull_bins_lanes.cl writes them
// intervals         float2 a tile
// cells             the light grid, uint2 a tile: .x first, .y count (-DCOUNT writes .y)
// indices           (fill) the light index list, INDEX (ushort or uint) each
//
// Tiled culling: Olsson, Assarsson, "Tiled Shading" (2011); Harada, McKee, Yang, "Forward+" (2012).
#include "kernels/common/bin.h"

#ifndef INDEX
#define INDEX uint
#endif

kernel void cull_tiles_lanes(global const uint2* bins, global const float* candidates, uint stride,
                             global const float4* cones, global const float2* intervals, global uint2* cells,
                             global INDEX* indices, uint index_capacity, constant ViewParams* view) {
  const uint bin = get_global_id(0);
  const uint begin = bins[bin].x, end = begin + bins[bin].y;
  if ((ulong)begin + bins[bin].y > stride) return;
  const uint tx0 = bin % view->bins_x * BIN_TILES, ty0 = bin / view->bins_x * BIN_TILES;
  const uint tx1 = min(tx0 + BIN_TILES, view->tiles_x), ty1 = min(ty0 + BIN_TILES, view->tiles_y);
  global const float* ys = candidates + stride;
  global const float* ds = ys + stride;
  global const float* rs = ds + stride;
  global const uint* lights = (global const uint*)(rs + stride);
  for (uint ty = ty0; ty < ty1; ++ty) {
    for (uint tx = tx0; tx < tx1; ++tx) {
      const uint tile = ty * view->tiles_x + tx;
      const Cell cell = tile_cell(tx, ty, intervals[tile], view);
      uint n = 0;
#ifndef COUNT
      global INDEX* list = indices + cells[tile].x;
      if ((ulong)cells[tile].x + cells[tile].y > index_capacity) continue;
#endif
      if (cell.near <= cell.far) {
        for (uint i = begin; i < end; i += LANES) {
          uint bits = mask_bits(sphere_may_touch(LOAD(candidates + i), LOAD(ys + i), LOAD(ds + i), LOAD(rs + i), &cell));
          if (end - i < LANES) bits &= (1u << (end - i)) - 1u;
#ifdef SPOTS
          for (uint left = bits; left; left &= left - 1) {
            const uint lane = lowest_bit(left), at = i + lane;
            if (!cone_may_touch(candidates[at], ys[at], ds[at], cones[lights[at]], &cell)) bits &= ~(1u << lane);
          }
#endif
#ifdef COUNT
          n += popcount(bits);
#else
          for (; bits; bits &= bits - 1) list[n++] = (INDEX)lights[i + lowest_bit(bits)];
#endif
        }
      }
#ifdef COUNT
      cells[tile].y = n;
#endif
    }
  }
}
