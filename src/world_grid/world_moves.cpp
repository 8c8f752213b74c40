#include "world_grid/world_moves.h"

namespace lightgrid {
namespace {

// Blocks first to below end along each axis.
struct BlockBox {
  uint32_t first[3], end[3];
  bool holds(uint32_t x, uint32_t y, uint32_t z) const {
    return x >= first[0] && x < end[0] && y >= first[1] && y < end[1] && z >= first[2] && z < end[2];
  }
};

BlockBox box_of(const WorldBlocks& of, const WorldGridParams& p) {
  const uint32_t x = of.first % p.blocks_x, y = of.first / p.blocks_x % p.blocks_y,
                 z = of.first / p.blocks_x / p.blocks_y;
  return {{x, y, z}, {x + of.x, y + of.y, z + of.z}};
}

// visit(block, whether it is in `other`) for each block of `box`.
void for_each_block(const BlockBox& box, const BlockBox& other, const WorldGridParams& p, const auto& visit) {
  for (uint32_t z = box.first[2]; z < box.end[2]; ++z)
    for (uint32_t y = box.first[1]; y < box.end[1]; ++y)
      for (uint32_t x = box.first[0]; x < box.end[0]; ++x)
        visit((z * p.blocks_y + y) * p.blocks_x + x, other.holds(x, y, z));
}

}  // namespace

void move_world_lights(std::span<const WorldLight> now, std::span<const uint32_t> buckets,
                       WorldLayout& layout, std::vector<uint32_t>& block_pairs, WorldMoves& moves) {
  const WorldGridParams& p = layout.params;
  const uint32_t count = uint32_t(block_pairs.size());
  struct Edit {
    uint32_t block, edit;
  };
  std::vector<Edit> edits;
  std::vector<uint32_t> places(count + 1,
                               0);  // of each block, its number of edits, then where its next one goes
  moves.balls.clear(), moves.cones.clear();
  for (uint32_t k = 0; k < now.size(); ++k) {
    const uint32_t i = moves.moved[k];
    const WorldLight& light = now[k];
    const BlockBox before = box_of(layout.light_blocks[i], p), after = box_of(light.of_cells, p);
    for_each_block(before, after, p, [&](uint32_t block, bool stays) {
      edits.push_back({block, k | edit_before | (stays ? edit_after : 0)});
      ++places[block];
      if (!stays) --block_pairs[block], --layout.pairs;
    });
    for_each_block(after, before, p, [&](uint32_t block, bool was) {
      if (was) return;
      edits.push_back({block, k | edit_after});
      ++places[block], ++block_pairs[block], ++layout.pairs;
    });
    const bool cones = !layout.cones.empty();
    moves.balls.insert(moves.balls.end(), {layout.lights[i], light.ball});
    moves.cones.insert(moves.cones.end(), {cones ? layout.cones[i] : light.cone, light.cone});
    layout.lights[i] = light.ball, layout.light_blocks[i] = light.of_cells;
    if (cones) layout.cones[i] = light.cone;
  }
  moves.buckets.resize(count + 1);
  moves.keys.clear(), moves.old_blocks.clear(), moves.edit_first.clear();
  uint32_t place = 0, x = 0, y = 0, z = 0;
  for (uint32_t block = 0; block < count; ++block) {
    const uint32_t of_block = places[block];
    places[block] = ~0u;
    moves.buckets[block] = uint32_t(moves.keys.size());
    if (block_pairs[block] > 0) {
      moves.keys.push_back(world_key(x, y, z, 0));
      moves.old_blocks.push_back(buckets[block] < buckets[block + 1] ? buckets[block] : ~0u);
      moves.edit_first.push_back(place);
      places[block] = place, place += of_block;
    }
    if (++x < p.blocks_x) continue;
    x = 0;
    if (++y < p.blocks_y) continue;
    y = 0, ++z;
  }
  moves.buckets[count] = uint32_t(moves.keys.size());
  moves.edit_first.push_back(place);
  moves.edits.resize(place);
  for (const Edit& edit : edits)
    if (places[edit.block] != ~0u) moves.edits[places[edit.block]++] = edit.edit;
}

}  // namespace lightgrid
