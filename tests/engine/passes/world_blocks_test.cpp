// The lights of each block by counting, against each light's blocks one after the other.
#include "world_grid/world_blocks.h"

#include <gtest/gtest.h>

#include <map>

#include "scene/random.h"

namespace lightgrid {
namespace {

// Numbers of blocks along x, y and z, and of lights: fewer and more than a part has.
struct BlockCase {
  uint32_t x, y, z;
  size_t lights;
};

WorldLayout random_blocks(const BlockCase& of, uint64_t seed) {
  Random random(seed);
  WorldLayout layout;
  WorldGridParams& p = layout.params;
  p.shift_z = 2;
  p.cells_z = of.z << 2;
  p.blocks_x = of.x;
  p.blocks_y = of.y;
  for (size_t i = 0; i < of.lights; ++i) {
    WorldBlocks& blocks = layout.light_blocks.emplace_back();
    layout.lights.emplace_back(0);
    if (random.next() % 10 == 0) continue;  // in no block
    const uint32_t most = random.next() % 10 == 0 ? 5 : 2;
    const auto along = [&](uint32_t count, uint32_t& first) {
      const uint32_t number = 1 + uint32_t(random.next() % std::min(most, count));
      first = uint32_t(random.next() % (count - number + 1));
      return uint16_t(number);
    };
    uint32_t x = 0, y = 0, z = 0;
    blocks.x = along(of.x, x);
    blocks.y = along(of.y, y);
    blocks.z = along(of.z, z);
    blocks.first = (z * of.y + y) * of.x + x;
    layout.pairs += uint64_t(blocks.x) * blocks.y * blocks.z;
  }
  return layout;
}

std::map<uint32_t, std::vector<uint32_t>> one_by_one(const WorldLayout& layout) {
  const WorldGridParams& p = layout.params;
  std::map<uint32_t, std::vector<uint32_t>> lights;
  for (uint32_t i = 0; i < layout.light_blocks.size(); ++i) {
    const WorldBlocks& of = layout.light_blocks[i];
    for (uint32_t z = 0; z < of.z; ++z)
      for (uint32_t y = 0; y < of.y; ++y)
        for (uint32_t x = 0; x < of.x; ++x)
          lights[of.first + (z * p.blocks_y + y) * p.blocks_x + x].push_back(i);
  }
  return lights;
}

TEST(WorldBlocks, HaveEachLightInItsOrder) {
  WorldBlockLights blocks;  // the same memory for all
  for (const BlockCase& of :
       {BlockCase{7, 5, 3, 1000}, {1, 1, 1, 20}, {40, 30, 20, 30000}, {2, 1, 9, 70000}}) {
    const WorldLayout layout = random_blocks(of, of.lights);
    ASSERT_TRUE(has_few_blocks(layout));
    count_world_blocks(layout, blocks);
    const std::map<uint32_t, std::vector<uint32_t>> expected = one_by_one(layout);
    const uint32_t count = of.x * of.y * of.z;
    ASSERT_EQ(blocks.buckets.size(), count + 1);
    EXPECT_EQ(blocks.keys.size(), expected.size());
    ASSERT_EQ(blocks.first.size(), expected.size() + 1);
    for (uint32_t block = 0, stored = 0; block < count; ++block) {
      ASSERT_EQ(blocks.buckets[block], stored);
      const auto found = expected.find(block);
      if (found == expected.end()) continue;
      const auto first = blocks.members.begin();
      EXPECT_EQ(std::vector(first + blocks.first[stored], first + blocks.first[stored + 1]), found->second);
      EXPECT_EQ(blocks.keys[stored], world_key(block % of.x, block / of.x % of.y, block / of.x / of.y, 0));
      ++stored;
    }
    EXPECT_EQ(blocks.buckets[count], blocks.keys.size());
    // world_lists loads these, and leaves them out.
    EXPECT_EQ(blocks.members.size(), layout.pairs + world_batch - 1);
    for (size_t i = size_t(layout.pairs); i < blocks.members.size(); ++i)
      EXPECT_LT(blocks.members[i], of.lights);
  }
}

}  // namespace
}  // namespace lightgrid
