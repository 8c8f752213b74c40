// cull with little memory: it allocates exactly what is needed if it cannot have more, and reports when that
// is too much.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "culling/culled_grid.h"
#include "shared/cull_tests.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;

// Refuses more than `most` bytes of indices, as OpenGL does past its texels.
class LimitedStorage : public ClGridStorage {
 public:
  LimitedStorage(ClDevice& device, size_t most) : ClGridStorage(device), most_(most) {}
  cl::Buffer& indices(size_t bytes) override {
    if (bytes > most_) throw machine_error("{} bytes are more than {}", bytes, most_);
    largest = std::max(largest, bytes);
    return ClGridStorage::indices(bytes);
  }
  size_t largest = 0;

 private:
  size_t most_;
};

// Lights of infinite range: each is in the list of each of 16 tiles.
std::vector<CullLight> endless_lights(size_t count) { return std::vector<CullLight>(count); }

struct CullMemory : testing::TestWithParam<KernelShape> {
  CullMemory() { culler.set_view(cull_view_of(view_of(64, 64, 60))); }
  LightGrid cull(size_t lights, GridStorage& storage) {
    culler.set_lights(endless_lights(lights));
    return culler.cull(culler.bounds_of(std::vector<DepthInterval>(16, {1, 2})), storage);
  }
  LightCuller culler{test_device(), test_programs(), {.shape = GetParam()}};
};

TEST_P(CullMemory, TakesWhatIsNeededWhereTheStorageHasNoMoreThanThat) {
  LimitedStorage storage(test_device(), 1 << 20);
  const LightGrid grid = cull(30000, storage);  // 960,000 bytes; a quarter more would be too much
  EXPECT_EQ(grid.index_count, 16u * 30000);
  EXPECT_EQ(grid.index_bytes, 960000u);
}

TEST_P(CullMemory, IsNotLostToACullThatWasRefused) {
  LimitedStorage storage(test_device(), 1 << 20);
  EXPECT_THROW(cull(60000, storage), Error);
  EXPECT_EQ(cull(10, storage).index_count, 160u);
  EXPECT_EQ(cull(30000, storage).index_count, 16u * 30000);
}

TEST_P(CullMemory, NeedsNoFirstGuess) {
  LimitedStorage storage(test_device(), 400);  // less than 64 indices a tile
  const LightGrid grid = cull(10, storage);
  EXPECT_EQ(grid.index_count, 160u);
  const HostGrid host = read_grid(test_device(), grid, storage);
  EXPECT_THAT(std::vector(host.indices.begin(), host.indices.begin() + 10),
              testing::ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8, 9));
}

INSTANTIATE_TEST_SUITE_P(Shapes, CullMemory, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "lanes" : "group";
                         });

// 16 tiles x 64 slices x 2^22 lights are 2^32 indices of one block. Counting them takes half a minute on a
// CPU and well under a second on a GPU, so a CPU does it only if LIGHTGRID_LONG_TESTS is set.
TEST(CullMemoryLimits, IndicesOfABlockPastTwoToThe32AreRefusedWithTheirNumber) {
  if (test_device().info().cpu && !std::getenv("LIGHTGRID_LONG_TESTS"))
    GTEST_SKIP() << "LIGHTGRID_LONG_TESTS is not set";
  const View view = view_of(32, 32, 60);
  LightCuller culler(test_device(), test_programs(),
                     {.cull_test = CullTest::sphere, .shape = KernelShape::group, .tile = 8});
  culler.set_lights(endless_lights(size_t(1) << 22));
  culler.set_view(cull_view_of(view, slice_edges(SliceSpacing::linear, 64, 0.1, 64)));
  ClGridStorage storage(test_device());
  EXPECT_THAT(error_of(
                  [&] {
                    culler.cull(culler.bounds_of(std::vector<DepthInterval>(16, {0.1f, 100})), storage);
                  },
                  ErrorKind::machine),
              HasSubstr("4294967296 light indices"));
}

}  // namespace
}  // namespace lightgrid
