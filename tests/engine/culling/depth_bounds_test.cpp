// Depth bounds against a plain scan in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "culling/constants.h"
#include "culling/culled_grid.h"
#include "oracle/position.h"
#include "scene/random.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr double ulp = 0x1p-23;
// Widening by 4 units in the last place, and the roundings that it contains and adds: see depth_interval.h.
constexpr double loosest = 8 * ulp;

const glm::ivec2 sizes[] = {{1, 1}, {17, 1}, {17, 9}, {127, 73}};

CullerOptions options_of(int tile, KernelShape shape) {
  CullerOptions options;
  options.tile = tile;
  options.shape = shape;
  options.blend = true;
  return options;
}

// Blocks of 8 x 8 pixels that are wholly sky, partly sky, or surfaces at scattered depths.
std::vector<float> scattered_depth(const View& view, uint64_t seed) {
  Random random(seed);
  const int blocks_x = view.width / 8 + 1;
  std::vector<int> kinds;
  for (int i = 0; i < blocks_x * (view.height / 8 + 1); ++i) kinds.push_back(int(random.next() % 4));
  std::vector<float> depth;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const int kind = kinds[y / 8 * blocks_x + x / 8];
      const float surface = std::exp2(-20 * random.uniform());
      const bool sky = kind == 0 || (kind == 1 && random.uniform() < 0.5f);
      depth.push_back(sky ? 0.0f : view.orthographic ? random.uniform() : surface);
    }
  }
  return depth;
}

struct Exact {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
  bool any = false, sky = false;
};

Exact scan(const View& view, const std::vector<float>& depth, int tile, int index) {
  const int tiles_x = (view.width + tile - 1) / tile;
  const int x0 = index % tiles_x * tile, y0 = index / tiles_x * tile;
  Exact exact;
  for (int y = y0; y < std::min(y0 + tile, view.height); ++y) {
    for (int x = x0; x < std::min(x0 + tile, view.width); ++x) {
      const float value = depth[size_t(y) * view.width + x];
      if (value == 0) {
        exact.sky = true;
        continue;
      }
      const double distance = std::min(-position_from_depth(view, x, y, value).z, double(far_away));
      exact.nearest = std::min(exact.nearest, distance);
      exact.farthest = std::max(exact.farthest, distance);
      exact.any = true;
    }
  }
  return exact;
}

void expect_bounds(const View& view, const std::vector<float>& depth, const CullerOptions& options) {
  const Intervals intervals = depth_intervals(view, depth, options);
  ASSERT_EQ(intervals.opaque.size(), tile_count(view, options.tile));
  for (size_t i = 0; i < intervals.opaque.size(); ++i) {
    SCOPED_TRACE(fmt::format("{}x{} tile size {} tile {}", view.width, view.height, options.tile, i));
    const Exact exact = scan(view, depth, options.tile, int(i));
    const glm::dvec2 opaque(intervals.opaque[i].near, intervals.opaque[i].far);
    const glm::dvec2 blend(intervals.blend[i].near, intervals.blend[i].far);
    // Orthographic depth has a precision relative to the whole range, not to the distance.
    const double range = view.orthographic ? 3 * view.far_m : 0;
    const bool past_the_farthest = exact.any && exact.farthest > 1e15;  // docs/hard_cases.md#the-domain
    if (past_the_farthest) {
      EXPECT_EQ(opaque, glm::dvec2(0, far_away));
    } else if (exact.any) {
      EXPECT_LE(opaque.x, exact.nearest);
      EXPECT_GE(opaque.x, exact.nearest - loosest * (exact.nearest + range));
      EXPECT_GE(opaque.y, exact.farthest);
      EXPECT_LE(opaque.y, exact.farthest + loosest * (exact.farthest + range));
    } else {
      EXPECT_EQ(opaque, glm::dvec2(far_away, -far_away));
    }
    EXPECT_LE(blend.x, view.near_m);
    EXPECT_GE(blend.x, view.near_m - loosest * (view.near_m + range));
    if (exact.sky || past_the_farthest) {
      EXPECT_EQ(blend.y, far_away);
    } else {
      EXPECT_GE(blend.y, exact.farthest);
      EXPECT_LE(blend.y, exact.farthest + loosest * (exact.farthest + range));
    }
  }
}

struct DepthBoundsOf : testing::TestWithParam<std::tuple<KernelShape, int>> {
  CullerOptions options = options_of(std::get<1>(GetParam()), std::get<0>(GetParam()));
};

TEST_P(DepthBoundsOf, ContainEveryPixelAndLittleMore) {
  for (const glm::ivec2 size : sizes) {
    const View infinite = view_of(size.x, size.y, 60);
    expect_bounds(infinite, scattered_depth(infinite, 1), options);
    const View finite = view_of(size.x, size.y, 60, 0.5, 300);
    expect_bounds(finite, scattered_depth(finite, 2), options);
    const View flat = orthographic_view_of(size.x, size.y, 10, 0, 100);
    expect_bounds(flat, scattered_depth(flat, 3), options);
  }
}

TEST_P(DepthBoundsOf, SkyAloneAndSurfacesAlone) {
  const View view = view_of(127, 73, 60);
  expect_bounds(view, std::vector<float>(127 * 73, 0.0f), options);
  expect_bounds(view, std::vector<float>(127 * 73, 1.0f), options);
  expect_bounds(view, std::vector<float>(127 * 73, std::numeric_limits<float>::min()), options);
}

TEST_P(DepthBoundsOf, OneSurfaceInTheLastPixelOfATile) {
  const View view = view_of(127, 73, 60);
  std::vector<float> depth(127 * 73, 0.0f);
  const int tile = options.tile;
  depth[size_t(72) * 127 + 126] = 0.25f;                // last of the last tile, which is cut off
  depth[size_t(tile - 1) * 127 + (tile - 1)] = 0.125f;  // last of the first
  expect_bounds(view, depth, options);
}

TEST_P(DepthBoundsOf, WhatNoDepthBufferHoldsGivesEveryDistance) {
  const float infinity = std::numeric_limits<float>::infinity(),
              nan = std::numeric_limits<float>::quiet_NaN();
  const View view = view_of(127, 73, 60);
  const std::vector<float> whole = scattered_depth(view, 4);
  const Intervals before = depth_intervals(view, whole, options);
  const int tiles_x = (view.width + options.tile - 1) / options.tile;
  for (const float value :
       {nan, -nan, infinity, -infinity, -1.0f, -0.0f, -1e-40f, std::nextafter(1.0f, 2.0f), 2.0f}) {
    SCOPED_TRACE(fmt::format("depth {}", value));
    std::vector<float> depth = whole;
    const int x = 70, y = 41, invalid = y / options.tile * tiles_x + x / options.tile;
    depth[size_t(y) * view.width + x] = value;
    const Intervals after = depth_intervals(view, depth, options);
    for (int i = 0; i < int(after.opaque.size()); ++i) {
      if (i == invalid) {
        EXPECT_EQ(after.opaque[i], (DepthInterval{0, far_away}));
        EXPECT_EQ(after.blend[i].far, far_away);
      } else {
        EXPECT_TRUE(after.opaque[i] == before.opaque[i]);
        EXPECT_TRUE(after.blend[i] == before.blend[i]);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, DepthBoundsOf,
                         testing::Combine(testing::Values(KernelShape::lanes, KernelShape::group),
                                          testing::Values(8, 16, 32, 64)),
                         [](const auto& info) {
                           const bool lanes = std::get<0>(info.param) == KernelShape::lanes;
                           return fmt::format("{}{}", lanes ? "lanes" : "group", std::get<1>(info.param));
                         });

TEST(DepthBounds, BothShapesGiveTheSameBytesAtAnAwkwardSize) {
  const View view = view_of(1279, 721, 60);
  const std::vector<float> depth = scattered_depth(view, 5);
  expect_bounds(view, depth, options_of(16, KernelShape::lanes));
  for (const int tile : {8, 16, 32, 64}) {
    const Intervals lanes = depth_intervals(view, depth, options_of(tile, KernelShape::lanes));
    const Intervals group = depth_intervals(view, depth, options_of(tile, KernelShape::group));
    EXPECT_TRUE(lanes.opaque == group.opaque) << tile;
    EXPECT_TRUE(lanes.blend == group.blend) << tile;
  }
}

TEST(DepthBounds, SwitchedOffEveryTileHoldsEveryDistance) {
  CullerOptions options = options_of(16, KernelShape::automatic);
  options.depth_bounds = DepthBoundsMode::none;
  for (const DepthInterval& interval :
       depth_intervals(view_of(17, 9, 60), std::vector<float>(17 * 9), options).opaque) {
    EXPECT_EQ(interval, (DepthInterval{0, far_away}));
  }
  for (const DepthInterval& interval :
       depth_intervals(orthographic_view_of(17, 9, 2, 0, 9), std::vector<float>(17 * 9), options).opaque) {
    EXPECT_EQ(interval, (DepthInterval{-far_away, far_away}));
  }
}

}  // namespace
}  // namespace lightgrid
