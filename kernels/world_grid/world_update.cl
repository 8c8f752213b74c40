// The lists of a world grid after some lights moved, from those before: runs of cells that no such light
// leaves or enters are copied. Runs twice: to test these lights and count entries, then, after world_scan, to
// write. The bytes are those of world_lists.
//
// moved        numbers of the lights that moved, ascending
// balls        two of each of them: position and radius before and after, as in world_blocks
// cones        likewise, as in world_lists
// edits, edit_first  of each block: lights that moved out of it, into it or within it, ascending, as places
//              in `moved`; EDIT_BEFORE, EDIT_AFTER: the block is around the light's ball before, after
// changes      of each edit: the cells that lose the light, and those that get it. Out, and with `write` in
// old_blocks   of each block: its number before the lights moved; UINT_MAX: it was not stored
// old_cells, old_indices  the lists before
// keys, totals, cells, indices  as in world_lists
// -DCOLUMNS, -DINDEX_32  as in world_lists
#include "kernels/common/index_type.h"
#include "kernels/world_grid/world_block.h"

#define EDIT_BEFORE 0x80000000u
#define EDIT_AFTER 0x40000000u
#define EDIT_LIGHT 0x3fffffffu

// Cells that lose a light and cells that get one. Returns what the block's number of entries grows by.
static inline int test_edits(global const float4* balls, global const float4* cones, global const uint* edits,
                             uint count, uint2 key, global ulong2* changes, constant WorldGridParams* world) {
  const BlockSides sides = block_sides(key, world);
  int grown = 0;
  for (uint i = 0; i < count; ++i) {
    const uint at = 2 * (edits[i] & EDIT_LIGHT);
    const ulong before = edits[i] & EDIT_BEFORE ? cells_of_light(balls[at], cones[at], &sides, world) : 0;
    const ulong after =
        edits[i] & EDIT_AFTER ? cells_of_light(balls[at + 1], cones[at + 1], &sides, world) : 0;
    changes[i] = (ulong2)(before & ~after, after & ~before);
    grown += (int)popcount(after) - (int)popcount(before);
  }
  return grown;
}

static inline void copy_indices(global const index_t* from, uint count, global index_t* to) {
  for (uint i = 0; i < count; ++i) to[i] = from[i];
}

// Writes a cell's list: the old one, less lights that left the cell, with those that came. Returns its
// length.
static inline uint merge_list(global const index_t* old, uint old_count, global const uint* moved,
                              global const uint* edits, global const ulong2* changes, uint count, ulong cell,
                              global index_t* to) {
  uint at = 0, from = 0;
  for (uint i = 0; i < count; ++i) {
    const bool leaves = (changes[i].x & cell) != 0, comes = (changes[i].y & cell) != 0;
    if (!leaves && !comes) continue;
    const uint light = moved[edits[i] & EDIT_LIGHT];
    while (from < old_count && old[from] < light) to[at++] = old[from++];
    if (comes) to[at++] = (index_t)light;
    if (leaves) ++from;
  }
  while (from < old_count) to[at++] = old[from++];
  return at;
}

kernel void world_update(global const uint* moved, global const float4* balls, global const float4* cones,
                         global const uint* edit_first, global const uint* edits, global ulong2* changes,
                         global const uint2* keys, global const uint* old_blocks,
                         global const uint2* old_cells, global const index_t* restrict old_indices,
                         global uint* totals, global uint2* cells, global index_t* restrict indices,
                         uint block_count, uint chunk, uint write, constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= block_count) return;
  const uint block_end = min(item * chunk + chunk, block_count);
  uint at = write ? totals[item] : 0;
  for (uint block = item * chunk; block < block_end; ++block) {
    const uint first = edit_first[block], count = edit_first[block + 1] - first;
    const bool is_new = old_blocks[block] == UINT_MAX;
    global const uint2* old = old_cells + (is_new ? 0 : (size_t)old_blocks[block] * WORLD_BLOCK_CELLS);
    if (!write) {
      const uint2 last = is_new ? (uint2)(0, 0) : old[WORLD_BLOCK_CELLS - 1];
      const uint entries = is_new ? 0 : last.x + last.y - old[0].x;
      at +=
          entries + (uint)test_edits(balls, cones, edits + first, count, keys[block], changes + first, world);
      continue;
    }
    ulong changed = 0;
    for (uint i = 0; i < count; ++i) changed |= changes[first + i].x | changes[first + i].y;
    global uint2* const own = cells + (size_t)block * WORLD_BLOCK_CELLS;
    uint copied = is_new ? 0 : old[0].x;  // entries before this one are in the new lists
    uint behind = copied;                 // the end of the last cell's list
    for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) {
      const uint2 before = is_new ? (uint2)(0, 0) : old[i];
      const uint start = at + (behind - copied);
      if ((changed >> i & 1) == 0) {
        own[i] = (uint2)(start, before.y);
        behind += before.y;
        continue;
      }
      copy_indices(old_indices + copied, behind - copied, indices + at);
      const uint length = merge_list(old_indices + behind, before.y, moved, edits + first, changes + first,
                                     count, 1ul << i, indices + start);
      own[i] = (uint2)(start, length);
      at = start + length;
      behind += before.y;
      copied = behind;
    }
    copy_indices(old_indices + copied, behind - copied, indices + at);
    at += behind - copied;
  }
  if (!write) totals[item] = at;
}
