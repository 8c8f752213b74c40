// Parts of the lights are counted in each block, then write their lights where those of the parts before end.
#include "world_grid/world_blocks.h"

#include <thread>

#include "world_grid/world_cell.h"

namespace lightgrid {
namespace {

// Fewer than for_each_part has, as each has a number for each block.
size_t lights_of_part(size_t lights) { return std::max(lights_part, (lights + 15) / 16); }

size_t block_count(const WorldGridParams& p) {
  return size_t(p.blocks_x) * p.blocks_y * std::max(p.cells_z >> p.shift_z, 1u);
}

// body(part, begin, end), on all cores. Parts that run at a time are far apart: neighbours write to the same
// cache lines, each behind the other in every block.
void for_each_counted_part(size_t lights, const auto& body) {
  const size_t part = lights_of_part(lights), parts = (lights + part - 1) / part;
  const size_t cores = std::max(std::thread::hardware_concurrency(), 1u), run = (parts + cores - 1) / cores;
  parallel_for(int(run * cores), [&](int i) {
    const size_t at = size_t(i) % cores * run + size_t(i) / cores;
    if (at < parts) body(at, at * part, std::min((at + 1) * part, lights));
  });
}

constexpr uint32_t spare_blocks = 8;  // behind those of the grid, for what visit_blocks leaves out

// visit(block, 1) for each of a light's blocks. Nearly all lights have one or two along each axis, and which
// of these cannot be predicted: all eight are then visited, those that are not the light's as visit(a spare
// block, 0).
inline void visit_blocks(const WorldBlocks& of, const WorldGridParams& p, uint32_t spare, const auto& visit) {
  const uint32_t next_layer = p.blocks_x * p.blocks_y;
  if (of.x > 2 || of.y > 2 || of.z > 2) {
    for (uint32_t z = 0, layer = of.first; z < of.z; ++z, layer += next_layer)
      for (uint32_t y = 0, row = layer; y < of.y; ++y, row += p.blocks_x)
        for (uint32_t x = 0; x < of.x; ++x) visit(row + x, 1u);
    return;
  }
  // Without a branch, which compilers make of "has ? block : spare".
  const auto visit_if = [&](uint32_t has, uint32_t block) {
    visit(spare ^ ((spare ^ block) & (0u - has)), has);
    ++spare;
  };
  const uint32_t some = of.x > 0, x = of.x > 1, y = of.y > 1, z = of.z > 1;
  const uint32_t row = of.first + p.blocks_x, layer = of.first + next_layer, both = row + next_layer;
  visit_if(some, of.first);
  visit_if(x, of.first + 1);
  visit_if(y, row);
  visit_if(x & y, row + 1);
  visit_if(z, layer);
  visit_if(x & z, layer + 1);
  visit_if(y & z, both);
  visit_if(x & y & z, both + 1);
}

// From numbers to places, and the stored blocks. Each part has `stride` numbers.
void place_blocks(const WorldGridParams& p, size_t parts, size_t stride, WorldBlockLights& blocks) {
  const size_t count = block_count(p);
  blocks.buckets.resize(count + 1);
  blocks.keys.clear();
  blocks.first.clear();
  uint32_t place = 0, x = 0, y = 0, z = 0;
  for (size_t block = 0; block < count; ++block) {
    const uint32_t first = place;
    for (size_t part = 0; part < parts; ++part) {
      uint32_t& of_part = blocks.places[part * stride + block];
      const uint32_t here = of_part;
      of_part = place;
      place += here;
    }
    blocks.buckets[block] = uint32_t(blocks.keys.size());
    if (place > first) {
      blocks.first.push_back(first);
      blocks.keys.push_back(world_key(x, y, z, 0));
    }
    if (++x < p.blocks_x) continue;
    x = 0;
    if (++y < p.blocks_y) continue;
    y = 0;
    ++z;
  }
  blocks.buckets[count] = uint32_t(blocks.keys.size());
  blocks.first.push_back(place);
  // Spare blocks write behind all members.
  uint32_t behind = place + uint32_t(world_batch) - 1;
  for (size_t part = 0; part < parts; ++part)
    for (uint32_t block = 0; block < spare_blocks; ++block)
      blocks.places[part * stride + count + block] = behind++;
}

}  // namespace

bool has_few_blocks(const WorldLayout& layout) {
  const size_t lights = layout.lights.size(), part = lights_of_part(lights);
  return layout.params.bucket_bits == 0 && layout.pairs > 0 &&
         block_count(layout.params) * ((lights + part - 1) / part) <= 4 * layout.pairs + 65536;
}

void count_world_blocks(const WorldLayout& layout, WorldBlockLights& blocks) {
  const WorldGridParams& p = layout.params;
  const size_t lights = layout.lights.size(), part = lights_of_part(lights);
  const size_t parts = (lights + part - 1) / part, stride = block_count(p) + spare_blocks;
  const uint32_t spare = uint32_t(block_count(p));
  blocks.places.assign(parts * stride, 0);
  for_each_counted_part(lights, [&](size_t at, size_t begin, size_t end) {
    uint32_t* const own = blocks.places.data() + at * stride;
    for (size_t i = begin; i < end; ++i)
      visit_blocks(layout.light_blocks[i], p, spare,
                   [&](uint32_t block, uint32_t add) { own[block] += add; });
  });
  place_blocks(p, parts, stride, blocks);
  blocks.members.resize(size_t(layout.pairs) + world_batch - 1 + parts * spare_blocks);
  for_each_counted_part(lights, [&](size_t at, size_t begin, size_t end) {
    uint32_t* const own = blocks.places.data() + at * stride;
    for (size_t i = begin; i < end; ++i)
      visit_blocks(layout.light_blocks[i], p, spare, [&](uint32_t block, uint32_t add) {
        blocks.members[own[block]] = uint32_t(i);
        own[block] += add;
      });
  });
  blocks.members.resize(size_t(layout.pairs));
  blocks.members.resize(size_t(layout.pairs) + world_batch - 1);  // with zeros
}

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
                               0);  // for each block, its number of edits, then where its next one goes
  moves.balls.clear();
  moves.cones.clear();
  for (uint32_t k = 0; k < now.size(); ++k) {
    const uint32_t i = moves.moved[k];
    const WorldLight& light = now[k];
    const BlockBox before = box_of(layout.light_blocks[i], p), after = box_of(light.of_cells, p);
    for_each_block(before, after, p, [&](uint32_t block, bool stays) {
      edits.push_back({block, k | edit_before | (stays ? edit_after : 0)});
      ++places[block];
      if (!stays) {
        --block_pairs[block];
        --layout.pairs;
      }
    });
    for_each_block(after, before, p, [&](uint32_t block, bool was) {
      if (was) return;
      edits.push_back({block, k | edit_after});
      ++places[block];
      ++block_pairs[block];
      ++layout.pairs;
    });
    const bool cones = !layout.cones.empty();
    moves.balls.insert(moves.balls.end(), {layout.lights[i], light.ball});
    moves.cones.insert(moves.cones.end(), {cones ? layout.cones[i] : light.cone, light.cone});
    layout.lights[i] = light.ball;
    layout.light_blocks[i] = light.of_cells;
    if (cones) layout.cones[i] = light.cone;
  }
  moves.buckets.resize(count + 1);
  moves.keys.clear();
  moves.old_blocks.clear();
  moves.edit_first.clear();
  uint32_t place = 0, x = 0, y = 0, z = 0;
  for (uint32_t block = 0; block < count; ++block) {
    const uint32_t of_block = places[block];
    places[block] = ~0u;
    moves.buckets[block] = uint32_t(moves.keys.size());
    if (block_pairs[block] > 0) {
      moves.keys.push_back(world_key(x, y, z, 0));
      moves.old_blocks.push_back(buckets[block] < buckets[block + 1] ? buckets[block] : ~0u);
      moves.edit_first.push_back(place);
      places[block] = place;
      place += of_block;
    }
    if (++x < p.blocks_x) continue;
    x = 0;
    if (++y < p.blocks_y) continue;
    y = 0;
    ++z;
  }
  moves.buckets[count] = uint32_t(moves.keys.size());
  moves.edit_first.push_back(place);
  moves.edits.resize(place);
  for (const Edit& edit : edits)
    if (places[edit.block] != ~0u) moves.edits[places[edit.block]++] = edit.edit;
}

}  // namespace lightgrid
