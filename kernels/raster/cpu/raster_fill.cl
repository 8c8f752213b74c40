// Records to the lists of the tiles that they may cover some of, for CPUs: one work-item takes a chunk.
//
// records, next_block, chunks  as raster/cpu/raster_setup.cl writes them
// tile_at   as raster/cpu/raster_scan.cl leaves tile_counts; where each chunk goes on in each tile's list
// lists     uint an entry: a record. Nothing is written where records or lists found no room.
#include "kernels/common/one_item.h"
#include "kernels/raster/raster_tiles.h"

kernel ONE_ITEM void raster_fill(global const RasterRecord* records, global const uint* next_block,
                                 global const uint2* chunks, global uint* tile_at, global uint* lists,
                                 global const uint* counters, constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  if (counters[RASTER_BLOCKS] > p->record_blocks || counters[RASTER_ENTRIES + 1] != 0 ||
      counters[RASTER_ENTRIES] > p->entry_capacity) {
    return;
  }
  const uint chunk = get_global_id(0), count = chunks[chunk].y;
  global uint* at = tile_at + (size_t)chunk * p->tiles_x * p->tiles_y;
  uint block = chunks[chunk].x;
  for (uint i = 0; i < count; ++i) {
    if (i != 0 && i % RASTER_BLOCK == 0) block = next_block[block];
    const uint place = block * RASTER_BLOCK + i % RASTER_BLOCK;
    const TileBox box = tile_box(records[place].box_low, records[place].box_high);
    if (!box.some_outside) {
      for (int y = box.y0; y <= box.y1; ++y) {
        for (int x = box.x0; x <= box.x1; ++x) lists[at[y * p->tiles_x + x]++] = place;
      }
      continue;
    }
    const RasterRecord record = records[place];
    for (int y = box.y0; y <= box.y1; ++y) {
      for (int x = box.x0; x <= box.x1; ++x) {
        if (meets_tile(&record, x, y)) lists[at[y * p->tiles_x + x]++] = place;
      }
    }
  }
}
