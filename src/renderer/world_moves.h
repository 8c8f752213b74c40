// What changes in the blocks of a counted world grid (world_blocks.h) when some of its lights move. Host code
// alone.
#pragma once

#include "renderer/world_blocks.h"
#include "renderer/world_lights.h"

namespace lightgrid {

// Flags of an edit: the block is around the light's ball before, or after, it moved. As in
// kernels/world_grid/world_update.cl.
constexpr uint32_t edit_before = 0x80000000u, edit_after = 0x40000000u;

struct WorldMoves {
  std::vector<uint32_t> moved;          // numbers of lights, ascending
  std::vector<glm::vec4> balls, cones;  // two of each: before, after
  // Of the stored blocks after the moves:
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
