// Where each chunk's part of each tile's list begins, for CPUs: one work-item adds up what
// raster/cpu/raster_setup.cl counted.
//
// tile_counts  in: entries of a tile for each chunk; out: where they begin
// tile_begin   uint a tile, and one more: where its list begins
// counters     RASTER_ENTRIES is written
#include "kernels/common/one_item.h"
#include "shared/raster_params.h"

kernel ONE_ITEM void raster_scan(global uint* tile_counts, global uint* tile_begin, global uint* counters,
                                 constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  const uint tiles = p->tiles_x * p->tiles_y;
  ulong sum = 0;
  for (uint tile = 0; tile < tiles; ++tile) {
    tile_begin[tile] = (uint)sum;
    for (uint chunk = 0; chunk < p->chunks; ++chunk) {
      global uint* count = tile_counts + (size_t)chunk * tiles + tile;
      const uint entries = *count;
      *count = (uint)sum;
      sum += entries;
    }
  }
  tile_begin[tiles] = (uint)sum;
  counters[RASTER_ENTRIES] = (uint)sum;
  counters[RASTER_ENTRIES + 1] = (uint)(sum >> 32);
}
