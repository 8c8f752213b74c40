// Bitmasks contain the same lights as the lists.
#include <gmock/gmock.h>

#include "base/error.h"
#include "culling/cell_truth.h"
#include "culling/constants.h"
#include "scene/random.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

std::vector<ViewLight> mask_lights(int count) {
  Random random(3);
  std::vector<ViewLight> lights;
  for (int i = 0; i < count; ++i) {
    lights.push_back(point_light({random.uniform(-4, 4), random.uniform(-3, 3), -random.uniform(1, 9)},
                                 random.uniform(0.1f, 2)));
  }
  return lights;
}

std::vector<uint32_t> set_bits(const CulledGrid& grid, size_t cell) {
  std::vector<uint32_t> lights;
  for (uint32_t i = 0; i < grid.grid.mask_words * 32; ++i) {
    if (grid.masks[cell * grid.grid.mask_words + i / 32] >> i % 32 & 1) lights.push_back(i);
  }
  return lights;
}

TEST(Masks, SayWhatTheListsSay) {
  const View view = view_of(127, 73, 60);
  const std::vector<glm::vec2> intervals(tile_count(view, 16), {0, far_away});
  for (const int count : {0, 1, 31, 32, 33, 64, 257}) {
    for (const auto& [edges, bits] :
         {std::pair(std::vector<float>(), 16), std::pair(std::vector<float>{2, 4}, 32)}) {
      SCOPED_TRACE(fmt::format("{} lights, {} edges", count, edges.size()));
      CullerOptions options;
      options.index_bits = bits;
      const CulledGrid lists = cull_cells(view, mask_lights(count), intervals, options, edges);
      EXPECT_TRUE(lists.masks.empty());
      options.lists = GridLists::masks;
      const CulledGrid grid = cull_cells(view, mask_lights(count), intervals, options, edges);
      EXPECT_EQ(grid, lists);
      ASSERT_EQ(grid.grid.mask_words, size_t(count + 31) / 32);
      ASSERT_EQ(grid.masks.size(), grid.cells.size() * grid.grid.mask_words);
      for (size_t cell = 0; cell < grid.cells.size(); ++cell)
        ASSERT_EQ(set_bits(grid, cell), grid.list(cell)) << cell;
    }
  }
}

TEST(Masks, TooLargeForTheDeviceAreAMachineError) {
  ClDevice device;
  const View view = view_of(127, 73, 60);
  const size_t tiles = tile_count(view, 16), lights = 32 * 1000;
  const_cast<ClDeviceInfo&>(device.info()).max_allocation_bytes = tiles * 1000 * sizeof(uint32_t) - 1;
  ProgramCache programs(device);
  CullerOptions options;
  options.lists = GridLists::masks;
  LightCuller culler(device, programs, options);
  culler.set_lights(cull_lights_of(std::vector<ViewLight>(lights, point_light({0, 0, 5}, 1))));
  culler.set_view(cull_view_of(view));
  ClGridStorage storage(device);
  EXPECT_THAT(error_of(
                  [&] {
                    culler.cull(culler.bounds_of(std::vector<DepthInterval>(tiles, {1.0f, 9.0f})), storage);
                  },
                  ErrorKind::machine),
              testing::HasSubstr("masks"));
}

}  // namespace
}  // namespace lightgrid
