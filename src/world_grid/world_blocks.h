// The lights of each block of a 2d or 3d world grid, by counting, on the host.
#pragma once

#include "world_grid/world_layout.h"

namespace lightgrid {

struct WorldBlockLights {
  std::vector<uint32_t>
      buckets;  // of each block of the grid, and of the end: how many stored blocks are before it
  std::vector<glm::uvec2> keys;   // of each stored block (world_key): those around any light's ball
  std::vector<uint32_t> first;    // of each stored block and of the end: its first light in `members`
  std::vector<uint32_t> members;  // ascending in each block; then world_batch - 1 more numbers of lights
  std::vector<uint32_t> places;   // memory of count_world_blocks
};

constexpr size_t world_batch = 16;  // lights that world_lists loads together: BATCH there

// Whether counting is cheaper than sorting pairs of blocks and lights.
bool has_few_blocks(const WorldLayout& layout);

// Replaces `blocks`, whose arrays keep their memory. layout.pairs is above 0 and below 2^32.
void count_world_blocks(const WorldLayout& layout, WorldBlockLights& blocks);

}  // namespace lightgrid
