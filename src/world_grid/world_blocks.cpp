// Parts of the lights are counted in each block, then write their lights where those of the parts before end.
#include "world_grid/world_blocks.h"

#include <thread>

#include "world_grid/lit_box.h"

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
  visit_if(some, of.first), visit_if(x, of.first + 1), visit_if(y, row), visit_if(x & y, row + 1);
  visit_if(z, layer), visit_if(x & z, layer + 1), visit_if(y & z, both), visit_if(x & y & z, both + 1);
}

// From numbers to places, and the stored blocks. Each part has `stride` numbers.
void place_blocks(const WorldGridParams& p, size_t parts, size_t stride, WorldBlockLights& blocks) {
  const size_t count = block_count(p);
  blocks.buckets.resize(count + 1), blocks.keys.clear(), blocks.first.clear();
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
    if (place > first) blocks.first.push_back(first), blocks.keys.push_back(world_key(x, y, z, 0));
    if (++x < p.blocks_x) continue;
    x = 0;
    if (++y < p.blocks_y) continue;
    y = 0, ++z;
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

}  // namespace lightgrid
