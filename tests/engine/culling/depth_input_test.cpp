// Depth buffers from other programs: part of a larger image, several samples, few bits, standard depth.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "culling/constants.h"
#include "culling/culled_grid.h"
#include "culling/projections.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

std::vector<DepthInterval> bounds_in(const CullView& view, const DepthInput& depth,
                                     const CullerOptions& options) {
  LightCuller culler(test_device(), test_programs(), options);
  culler.set_view(view);
  return culler.read_bounds(culler.depth_bounds(depth).opaque);
}

std::vector<float> random_depth(size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<float> depth(count);
  for (float& value : depth) value = random.next() % 8 == 0 ? 0.0f : std::exp2(-10 * random.uniform());
  return depth;
}

// The surroundings of the part are nearer than the part: a value read from there would be detected.
TEST(DepthInput, ThatIsPartOfALargerImageGivesTheBoundsOfThatPart) {
  const glm::ivec2 image(100, 60), corner(41, 13), size(37, 21);
  const std::vector<float> part = random_depth(size.x * size.y, 1);
  std::vector<float> whole(image.x * image.y, 1.0f);
  for (int y = 0; y < size.y; ++y) {
    std::copy_n(part.begin() + y * size.x, size.x, whole.begin() + (corner.y + y) * image.x + corner.x);
  }
  const CullView view = view_through(projections()[0], size.x, size.y);
  for (const KernelShape shape : kernel_shapes) {
    const CullerOptions options{.shape = shape};
    const auto expected = bounds_in(view, {buffer_of(part)}, options);
    EXPECT_TRUE(bounds_in(view, {buffer_of(whole), image.x, corner.x, corner.y}, options) == expected);
    for (const glm::ivec2 off : {glm::ivec2(1, 0), glm::ivec2(-1, 0), glm::ivec2(0, 1), glm::ivec2(0, -1)}) {
      const DepthInput shifted{buffer_of(whole), image.x, corner.x + off.x, corner.y + off.y};
      EXPECT_FALSE(bounds_in(view, shifted, options) == expected);
    }
  }
}

// 64 pixels of 8 samples are more values in a row of a tile than a group has items.
TEST(DepthInput, OfSeveralSamplesGivesBoundsOfAll) {
  const int width = 150, height = 70;
  const CullView view = view_through(projections()[0], width, height);
  const size_t pixels = size_t(width) * height;
  for (const auto& [tile, samples] : {std::pair(16, 2), std::pair(16, 4), std::pair(64, 8)}) {
    const std::vector<float> depth = random_depth(pixels * samples, 2 + samples);
    for (const KernelShape shape : kernel_shapes) {
      std::vector<DepthInterval> expected;
      for (int s = 0; s < samples; ++s) {
        std::vector<float> one(pixels);
        for (size_t i = 0; i < pixels; ++i) one[i] = depth[i * samples + s];
        const auto bounds = bounds_in(view, {buffer_of(one)}, {.shape = shape, .tile = tile});
        if (s == 0) expected = bounds;
        for (size_t i = 0; i < bounds.size(); ++i) {
          expected[i] = {std::min(expected[i].near, bounds[i].near),
                         std::max(expected[i].far, bounds[i].far)};
        }
      }
      EXPECT_TRUE(bounds_in(view, {buffer_of(depth)}, {.shape = shape, .tile = tile, .samples = samples}) ==
                  expected)
          << samples;
    }
  }
}

// Surfaces at many distances, one a tile, rounded to a depth format of few bits. Returns the number of tiles
// whose bounds miss the true distance. Values rounded to the far end count as sky.
int missed(const Projection& made, DepthFormat written, DepthFormat told, KernelShape shape) {
  const int tiles = 400, tile = 8;
  const double steps = written == DepthFormat::d16 ? 65535 : 16777215;
  const double far_m = std::isinf(made.far_m) ? 500 : made.far_m, near_m = std::max(made.near_m, 0.01);
  std::vector<double> distances;
  std::vector<float> depth;
  for (int i = 0; i < tiles; ++i) {
    distances.push_back(near_m * std::pow(far_m / near_m, (i + 0.5) / tiles));
    depth.insert(depth.end(), tile, float(std::round(made.depth_at(distances.back()) * steps) / steps));
  }
  const CullView view = view_through(made, tiles * tile, 1);
  const auto bounds =
      bounds_in(view, {buffer_of(depth)}, {.shape = shape, .tile = tile, .depth_format = told});
  int count = 0, skies = 0;
  for (int i = 0; i < tiles; ++i) {
    const bool sky = depth[i * tile] == (made.standard ? 1 : 0);
    skies += sky;
    count += !sky && !(bounds[i].near <= distances[i] && distances[i] <= bounds[i].far);
  }
  EXPECT_LT(skies, 5);
  return count;
}

TEST(DepthInput, OfFewBitsGivesBoundsThatHoldTheTrueDistance) {
  for (const Projection& made : projections()) {
    for (const DepthFormat format : {DepthFormat::d16, DepthFormat::d24}) {
      SCOPED_TRACE(made.name + (format == DepthFormat::d16 ? ", 16 bits" : ", 24 bits"));
      for (const KernelShape shape : kernel_shapes) EXPECT_EQ(missed(made, format, format, shape), 0);
      // The format makes a difference.
      if (format == DepthFormat::d16) {
        EXPECT_GT(missed(made, format, DepthFormat::d32f, KernelShape::lanes), 100);
      }
    }
  }
}

// Depths that both orders represent exactly: 1 minus the other.
TEST(DepthInput, InStandardDepthGivesTheGridOfReversedDepth) {
  const int width = 127, height = 73;
  Random random(5);
  std::vector<float> reversed, standard;
  for (int i = 0; i < width * height; ++i) {
    const bool sky = random.next() % 8 == 0;
    reversed.push_back(sky ? 0.0f : float(1 + random.next() % 4095) / 4096);
    standard.push_back(1 - reversed.back());
  }
  std::vector<CullLight> lights;
  for (int i = 0; i < 300; ++i) {
    const double d = random.uniform(0.5, 40);
    lights.push_back({{random.uniform(-1, 1) * d, random.uniform(-1, 1) * d, -d}, 0.1 * d});
  }
  for (const bool orthographic : {false, true}) {
    for (const KernelShape shape : kernel_shapes) {
      std::vector<HostGrid> grids;
      for (const bool is_standard : {false, true}) {
        const Projection made = orthographic ? projection("", true, is_standard, 0, 32, -8, 8, -5, 5)
                                             : projection("", false, is_standard, 0.5, 50);
        LightCuller culler(test_device(), test_programs(), {.shape = shape});
        culler.set_lights(lights);
        culler.set_view(view_through(made, width, height));
        ClGridStorage storage(test_device());
        const DepthBounds bounds = culler.depth_bounds({buffer_of(is_standard ? standard : reversed)});
        grids.push_back(read_grid(test_device(), culler.cull(bounds.opaque, storage), storage));
      }
      EXPECT_TRUE(grids[0] == grids[1]);
      EXPECT_GT(grids[0].indices.size(), 100u);
    }
  }
}

TEST(DepthInput, TilesWithValuesThatAreNoDepthAreCountedOnce) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const KernelShape shape : kernel_shapes) {
    LightCuller culler(test_device(), test_programs(), {.shape = shape});
    culler.set_view(view_through(projections()[0], 64, 32));  // 4 x 2 tiles
    std::vector<float> depth(64 * 32, 0.5f);
    culler.depth_bounds({buffer_of(depth)});
    EXPECT_EQ(culler.invalid_depth_tiles(), 0u);
    depth[0] = nan;
    depth[1] = -1;
    depth[20] = 2;
    depth[31 * 64 + 63] = INFINITY;  // in three tiles
    culler.depth_bounds({buffer_of(depth)});
    EXPECT_EQ(culler.invalid_depth_tiles(), 3u);
  }
}

TEST(DepthInput, GivenIntervalsAreReadBackAsTheyWere) {
  LightCuller culler(test_device(), test_programs(), {});
  culler.set_view(view_through(projections()[0], 40, 20));  // 3 x 2 tiles
  const std::vector<DepthInterval> given = {{1, 2}, {0.5f, 0.5f}, {3, 1e30f}, {2, 1}};
  const DepthInterval none{1e18f, -1e18f};
  EXPECT_THAT(culler.read_bounds(culler.bounds_of(given)),
              testing::ElementsAre(given[0], given[1], DepthInterval{3, 1e18f}, none, none, none));
}

}  // namespace
}  // namespace lightgrid
