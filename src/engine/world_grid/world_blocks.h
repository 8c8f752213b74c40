// The lights of each block of a 2d or 3d world grid, by counting, on the host.
#pragma once

#include "world_grid/world_layout.h"

namespace lightgrid {

struct WorldBlockLights {
  std::vector<uint32_t>
      buckets;  // for each block of the grid, and for the end: the number of stored blocks before it
  std::vector<glm::uvec2> keys;   // each stored block's key (world_key): those around any light's ball
  std::vector<uint32_t> first;    // for each stored block and for the end: its first light in `members`
  std::vector<uint32_t> members;  // ascending in each block; then world_batch - 1 more numbers of lights
  std::vector<uint32_t> places;   // memory of count_world_blocks
};

constexpr size_t world_batch = 16;  // lights that world_lists loads together: BATCH there

// True if counting is cheaper than sorting pairs of blocks and lights.
bool has_few_blocks(const WorldLayout& layout);

// Replaces `blocks`, whose arrays keep their memory. layout.pairs is above 0 and below 2^32.
void count_world_blocks(const WorldLayout& layout, WorldBlockLights& blocks);

// Flags of an edit: the block is around the light's ball before, or after, it moved. As in
// kernels/world_grid/world_update.cl.
constexpr uint32_t edit_before = 0x80000000u, edit_after = 0x40000000u;

struct WorldMoves {
  std::vector<uint32_t> moved;          // numbers of lights, ascending
  std::vector<glm::vec4> balls, cones;  // two of each: before, after
  // The stored blocks after the moves have:
  std::vector<uint32_t> buckets, old_blocks, edit_first;  // old_blocks: numbers before; ~0: not stored then
  std::vector<glm::uvec2> keys;
  std::vector<uint32_t> edits;  // places in `moved` with flags, by block, then ascending
};

// Moves lights of the layout, whose `pairs` follow, and replaces `moves`, whose arrays keep their memory.
// now: of moves.moved, each a light of ordinary cells or of none (not `everywhere`). block_pairs: of each
// block of the grid its number of lights, in and out; buckets: of the grid before.
void move_world_lights(std::span<const WorldLight> now, std::span<const uint32_t> buckets,
                       WorldLayout& layout, std::vector<uint32_t>& block_pairs, WorldMoves& moves);

}  // namespace lightgrid
