// From each work-item's numbers of lights in blocks (world_count) to places: where each item writes its lights of each block.
// One work-item.
//
// counts       item_count times block_count: numbers in, first places out
// block_first  out: of each stored block, its first member, and one more for the end
// keys         out: of each stored block
// buckets      out: block_count + 1 first stored blocks
// totals       out: stored blocks
#include "shared/world_grid.h"

kernel void world_places(global uint* counts, global uint* block_first, global uint2* keys, global uint* buckets,
                         global uint* totals, uint item_count, uint block_count, constant WorldGridParams* world) {
  uint place = 0, stored = 0, x = 0, y = 0, z = 0;
  for (uint block = 0; block < block_count; ++block) {
    const uint first = place;
    for (uint item = 0; item < item_count; ++item) {
      global uint* const count = counts + (size_t)item * block_count + block;
      const uint here = *count;
      *count = place;
      place += here;
    }
    buckets[block] = stored;
    if (place > first) block_first[stored] = first, keys[stored++] = world_key(x, y, z, 0);
    if (++x < world->blocks_x) continue;
    x = 0;
    if (++y < world->blocks_y) continue;
    y = 0, ++z;
  }
  buckets[block_count] = stored, block_first[stored] = place;
  totals[0] = stored, totals[1] = 0;
}
