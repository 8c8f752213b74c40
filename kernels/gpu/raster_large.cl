// Large triangles to the image, for GPUs: a work-group of 64 takes entries in turn, a tile of a record each.
//
// records, entries, counters  as gpu/raster_small.cl writes them
// MASK_ARGUMENTS              kernels/common/raster_masks.h
// keys, triangles, depths     the image: kernels/common/raster_image.h, with -DATOMICS and -DPASS
#include "kernels/common/raster_image.h"
#include "kernels/common/raster_tiles.h"

kernel void raster_large(global const RasterRecord* records, global const uint2* entries, MASK_ARGUMENTS,
                         global volatile ulong* keys, global volatile uint* triangles,
                         global volatile uint* depths, global const uint* counters,
                         constant RasterParams* p) {
  if (counters[RASTER_BLOCKS] > p->record_blocks || counters[RASTER_ENTRIES + 1] != 0 ||
      counters[RASTER_ENTRIES] > p->entry_capacity) {
    return;
  }
  const Image image = {keys, triangles, depths, p->width, MASK_SOURCE(p)};
  const int item = (int)get_local_id(0);
  for (uint i = get_group_id(0); i < counters[RASTER_ENTRIES]; i += get_num_groups(0)) {
    const RasterRecord record = records[entries[i].x];
    const int left = (int)(entries[i].y & 0xffffu) * RASTER_TILE,
              bottom = (int)(entries[i].y >> 16) * RASTER_TILE;
    const int x0 = max((int)(record.box_low & 0xffffu), left), y0 = max((int)(record.box_low >> 16), bottom);
    const int x1 = min((int)(record.box_high & 0xffffu), left + RASTER_TILE - 1);
    const int y1 = min((int)(record.box_high >> 16), bottom + RASTER_TILE - 1);
    draw_pixels(&record, x0, y0, x1, y1, item % 8, item / 8, 8, 8, &image);
  }
}
