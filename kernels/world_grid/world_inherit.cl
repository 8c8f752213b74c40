// Adds to each block the lights of larger levels that reach it, so that a position reads one list. Lists stay
// sorted: those of the block and of the blocks around it are merged. Runs twice: to count, then, after
// world_scan, to write.
//
// lights       as in world_blocks
// block_first, members  in: of each block, its own lights
// keys, buckets  as world_entries writes them
// totals       a chunk's number of lights out; with `write` its first place in
// full_first, full_members  out with `write`: of each block, with those of larger levels;
//                           behind the members 15 more numbers
//              of lights, as in world_entries
// counted, most  of world_counts_enough: counting then stops
#include "kernels/world_grid/world_cells.h"

static inline uint world_block_of(uint2 key, global const uint2* keys, global const uint* buckets,
                                  constant WorldGridParams* world) {
  const uint bucket = world_bucket(key, world), end = buckets[bucket + 1];
  for (uint block = buckets[bucket]; block < end; ++block) {
    if (all(keys[block] == key)) return block;
  }
  return UINT_MAX;
}

kernel void world_inherit(global const float4* lights, global const uint* block_first,
                          global const uint* members, global const uint2* keys, global const uint* buckets,
                          global uint* totals, global uint* full_first, global uint* full_members,
                          global volatile uint* counted, uint most, uint block_count, uint chunk, uint write,
                          constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= block_count) return;
  const uint block_end = min(item * chunk + chunk, block_count);
  uint at = write ? totals[item] : 0;
  for (uint block = item * chunk; block < block_end; ++block) {
    const uint2 key = keys[block];
    const uint x = key.x & 0xffffu, y = key.x >> 16, z = key.y & 0xffffu, level = key.y >> 16;
    uint next[WORLD_LEVELS], end[WORLD_LEVELS], lists = 1;
    next[0] = block_first[block];
    end[0] = block_first[block + 1];
    for (uint levels = world->levels & ~((2u << level) - 1u); levels != 0; levels &= levels - 1) {
      const uint above = lowest_bit(levels), up = above - level;
      const uint around = world_block_of(world_key(x >> up, y >> up, z >> up, above), keys, buckets, world);
      if (around == UINT_MAX) continue;
      next[lists] = block_first[around];
      end[lists++] = block_first[around + 1];
    }
    if (!write) {
      uint reach = end[0] - next[0];
      for (uint list = 1; list < lists; ++list) {
        for (uint m = next[list]; m < end[list]; ++m)
          reach += world_meets_block(lights[members[m]], x, y, z, level, world);
      }
      if (world_counts_enough(reach, &at, counted, most)) break;
      continue;
    }
    full_first[block] = at;
    for (;;) {
      uint least = UINT_MAX, from = 0;
      for (uint list = 0; list < lists; ++list) {
        // A light of a larger level that misses the block is passed over.
        while (list > 0 && next[list] < end[list] &&
               !world_meets_block(lights[members[next[list]]], x, y, z, level, world)) {
          ++next[list];
        }
        if (next[list] < end[list] && members[next[list]] < least) {
          least = members[next[list]];
          from = list;
        }
      }
      if (least == UINT_MAX) break;
      full_members[at++] = least;
      ++next[from];
    }
    if (block + 1 < block_count) continue;
    full_first[block_count] = at;
    for (uint past = 0; past < 15; ++past) full_members[at + past] = members[0];
  }
  if (!write) totals[item] = at;
}
