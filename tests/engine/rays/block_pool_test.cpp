#include "rays/block_pool.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <vector>

#include "base/resident.h"
#include "cl/transfer.h"
#include "rays/ray_scenes.h"
#include "rays/soups.h"

namespace lightgrid {
namespace {

constexpr size_t unit = BlockPool::unit_bytes;

TEST(BlockPool, BlocksNeverOverlapAndAllRoomComesBack) {
  BlockPool pool;
  EXPECT_FALSE(pool.take(1));
  ASSERT_TRUE(pool.grow(rays_device(), 1000 * unit, 1000 * unit));
  EXPECT_FALSE(pool.grow(rays_device(), unit, 1000 * unit));
  struct Block {
    uint32_t first;
    size_t bytes;
  };
  RandomNumbers random(1);
  std::vector<Block> blocks;
  std::vector<int> owners(1000);
  const auto count = [&](const Block& b, int by) {
    for (size_t i = b.first; i < b.first + (b.bytes + unit - 1) / unit; ++i) owners[i] += by;
  };
  size_t refused = 0;
  for (int step = 0; step < 3000; ++step) {
    if (random.below(5) < 3 || blocks.empty()) {
      const size_t bytes = size_t(1 + random.below(60 * int(unit)));
      const auto first = pool.take(bytes);
      if (!first && ++refused) continue;
      count(blocks.emplace_back(*first, bytes), 1);
    } else {
      Block& block = blocks[size_t(random.below(int(blocks.size())))];
      const size_t kept = random.below(2) ? 0 : size_t(random.below(int(block.bytes)));
      count(block, -1);
      pool.shrink(block.first, block.bytes, kept);
      block.bytes = kept;
      count(block, 1);
      if (kept == 0) {
        block = blocks.back();
        blocks.pop_back();
      }
    }
    ASSERT_LE(*std::ranges::max_element(owners), 1) << "step " << step;
  }
  EXPECT_GT(refused, 10u);
  for (const Block& block : blocks) pool.shrink(block.first, block.bytes, 0);
  EXPECT_EQ(pool.take(1000 * unit), 0u);
}

TEST(BlockPool, GrowingKeepsContents) {
  BlockPool pool;
  ASSERT_TRUE(pool.grow(rays_device(), 4 * unit, 8 * unit));
  const uint32_t first = *pool.take(4 * unit);
  std::vector<uint32_t> written(unit, 77), read(unit);
  write_buffer(rays_device(), "blocks", pool.buffer(), written.data(), 4 * unit);
  ASSERT_TRUE(pool.grow(rays_device(), unit, 8 * unit));
  EXPECT_EQ(pool.take(4 * unit), 4u);
  read_buffer(rays_device(), "blocks", pool.buffer(), read.data(), 4 * unit, first * unit);
  EXPECT_EQ(read, written);
  EXPECT_EQ(pool.bytes(), 8 * unit);
}

// A frame then goes on without lists.
TEST(BlockPool, MemoryThatTheDeviceLacksIsNoError) {
  BlockPool pool;
  ASSERT_TRUE(pool.grow(rays_device(), unit, size_t(1) << 30));
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  const uint64_t left = usable_memory();
  rlimit less = before;
  less.rlim_cur = 1 << 20;  // below what the process has: nothing is left
  ASSERT_EQ(setrlimit(RLIMIT_AS, &less), 0);
  const bool grew = pool.grow(rays_device(), size_t(64) << 20, size_t(1) << 30);
  ASSERT_EQ(setrlimit(RLIMIT_AS, &before), 0);
  EXPECT_GT(left, uint64_t(64) << 20);
  EXPECT_FALSE(grew);
  EXPECT_TRUE(pool.take(unit));
  EXPECT_FALSE(pool.grow(rays_device(), size_t(64) << 20, size_t(1) << 30)) << "asked again in each frame";
}

}  // namespace
}  // namespace lightgrid
