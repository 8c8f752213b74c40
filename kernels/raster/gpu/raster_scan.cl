// Where each chunk's part of each tile's list begins, for GPUs: one work-group of RASTER_SCAN_GROUP, an item
// a run of tiles. The same numbers as raster/cpu/raster_scan.cl, with the same arguments.
#include "shared/raster_params.h"

kernel void raster_scan(global uint* tile_counts, global uint* tile_begin, global uint* counters,
                        constant RasterParams* p) {
  local ulong sums[RASTER_SCAN_GROUP];
  const uint tiles = p->tiles_x * p->tiles_y, item = get_local_id(0);
  const uint run = (tiles + RASTER_SCAN_GROUP - 1) / RASTER_SCAN_GROUP;
  const uint first = min(item * run, tiles), end = min(first + run, tiles);
  ulong sum = 0;
  for (uint chunk = 0; chunk < p->chunks; ++chunk) {
    for (uint tile = first; tile < end; ++tile) sum += tile_counts[(size_t)chunk * tiles + tile];
  }
  sums[item] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  ulong at = 0;
  for (uint i = 0; i < item; ++i) at += sums[i];
  for (uint tile = first; tile < end; ++tile) {
    tile_begin[tile] = (uint)at;
    for (uint chunk = 0; chunk < p->chunks; ++chunk) {
      global uint* count = tile_counts + (size_t)chunk * tiles + tile;
      const uint entries = *count;
      *count = (uint)at;
      at += entries;
    }
  }
  if (item + 1 < RASTER_SCAN_GROUP) return;
  tile_begin[tiles] = (uint)at;
  counters[RASTER_ENTRIES] = (uint)at;
  counters[RASTER_ENTRIES + 1] = (uint)(at >> 32);
}
