// Large triangles to the image, for GPUs: a work-group of 64 takes entries in turn, a window of a record
// each. First a work-item looks at a block of 8 x 8 pixels; then all draw the blocks that the triangle may
// meet, a pixel each.
//
// records, entries, counters  as raster/gpu/raster_small.cl writes them
// MASK_ARGUMENTS              kernels/raster/raster_masks.h
// keys, triangles, depths     the image: kernels/raster/raster_image.h, with -DATOMICS and -DPASS
#include "kernels/raster/raster_image.h"
#include "kernels/raster/raster_tiles.h"
#include "shared/lanes.h"

#define BLOCK 8                       // pixels a side: a work-item each
#define BLOCKS (RASTER_TILE / BLOCK)  // a side of a window: a work-item each

// Returns whether the triangle may cover a pixel of the block whose first pixel is (x, y) of the window: the
// block meets the record's box, and lies outside no edge.
static inline bool meets_block(const PlacedTriangle* t, const RasterRecord* r, int x, int y) {
  bool meets = t->x0 + x <= (int)(r->box_high & 0xffffu) && t->y0 + y <= (int)(r->box_high >> 16) &&
               t->x0 + x + BLOCK > (int)(r->box_low & 0xffffu) && t->y0 + y + BLOCK > (int)(r->box_low >> 16);
  for (int k = 0; k < 3; ++k) {
    const Edge e = t->edges[k];
    meets &= edge_of_samples(e) + e.a * x + e.b * y + (max(e.a, 0) + max(e.b, 0)) * (BLOCK - 1) >= 0;
  }
  return meets;
}

// This work-item's pixel of a block, which the view's right and upper ends may cut.
static inline SeenPixel see_in_block(const PlacedTriangle* t, uint block, uint item, bool drawn,
                                     const Image* image) {
  const int x = (int)(block % BLOCKS * BLOCK + item % BLOCK),
            y = (int)(block / BLOCKS * BLOCK + item / BLOCK);
  return see_pixel(t, x, y, drawn & (x < t->width) & (y < t->height), image);
}

kernel __attribute__((reqd_work_group_size(BLOCKS * BLOCKS, 1, 1))) void raster_large(
    global const RasterRecord* records, global const uint2* entries, MASK_ARGUMENTS,
    global volatile ulong* keys, global volatile uint* triangles, global volatile uint* depths,
    global const uint* counters, constant RasterParams* p) {
  // A bit a block. Entries take one pair of words and the other in turn, which saves a barrier.
  local volatile uint met[2][2];
  if (counters[RASTER_BLOCKS] > p->record_blocks || counters[RASTER_ENTRIES + 1] != 0 ||
      counters[RASTER_ENTRIES] > p->entry_capacity) {
    return;
  }
  const Image image = {keys, (global volatile int*)triangles, depths, p->width, MASK_SOURCE(p)};
  const uint item = get_local_id(0);
  for (uint i = get_group_id(0), turn = 0; i < counters[RASTER_ENTRIES]; i += get_num_groups(0), turn ^= 1) {
    const uint2 entry = entries[i];
    const RasterRecord record = records[entry.x];
    const int x0 = (int)(entry.y & 0xffffu), y0 = (int)(entry.y >> 16);
    const PlacedTriangle t = placed_triangle(&record, x0, y0, (int)(record.box_high & 0xffffu) - x0 + 1,
                                             (int)(record.box_high >> 16) - y0 + 1);
    if (item < 2) met[turn][item] = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (meets_block(&t, &record, (int)(item % BLOCKS * BLOCK), (int)(item / BLOCKS * BLOCK)))
      atomic_or(&met[turn][item / 32], 1u << item % 32);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint half_window = 0; half_window < 64; half_window += 32) {
      // Two blocks at once: both pixels of the image are on their way before either is compared.
      for (uint left = met[turn][half_window / 32]; left != 0; left &= left - 1) {
        const uint first = lowest_bit(left);
        left &= left - 1;
        const SeenPixel one = see_in_block(&t, half_window + first, item, true, &image);
        const SeenPixel two =
            see_in_block(&t, half_window + (left ? lowest_bit(left) : first), item, left != 0, &image);
        draw_seen(&t, one, &image);
        draw_seen(&t, two, &image);
      }
    }
  }
}
