// The light grid, between the lights that certainly touch a cell and those that possibly do.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "culling/cell_truth.h"
#include "culling/constants.h"
#include "oracle/lit_set.h"
#include "oracle/test_views.h"
#include "scene/random.h"
#include "shared/cull_tests.h"
#include "support/error_of.h"
#include "support/long_tests.h"

namespace lightgrid {
using namespace lab;
namespace {

constexpr double degree = 3.14159265358979323846 / 180;
constexpr double half_angles_deg[] = {0.1, 30, 60, 89.9, 90, 120};

struct NamedView {
  const char* name;
  View view;
  double inset;  // cells to pixel edges where slack covers the slopes' rounding: docs/hard_cases.md#slack
};

std::vector<NamedView> views(int width, int height) {
  return {{"0.1 degrees", view_of(width, height, 0.1), 0},
          {"60 degrees", view_of(width, height, 60), 0},
          {"170 degrees", view_of(width, height, 170), 0.5},
          {"179 degrees", view_of(width, height, 179), 0.5},
          {"off centre", perspective_view(width, height, 0.5, 0.3, 0.1, 200, 0.3, -0.2), 0},
          {"orthographic", orthographic_view_of(width, height, 5, 0, 100), 0}};
}

// Around the view at all distances, behind the eye included; of sizes between a pixel and the whole image.
std::vector<ViewLight> scattered_lights(const View& view, int count, bool spots, uint64_t seed) {
  Random random(seed);
  std::vector<ViewLight> lights;
  for (int i = 0; i < count; ++i) {
    const double px = view.width * (1.4 * random.uniform() - 0.2),
                 py = view.height * (1.4 * random.uniform() - 0.2);
    const double d = 0.05 * std::exp2(11 * random.uniform()) * (i % 10 == 0 ? -1 : 1);
    const double scale = view.orthographic ? 1 : d;
    const glm::dvec3 p(view_x_of_pixel(view, px) * scale, view_y_of_pixel(view, py) * scale, -d);
    const double image = (view_x_of_pixel(view, view.width) - view_x_of_pixel(view, 0)) * std::abs(scale);
    const float radius = float(image * std::exp2(-9 * random.uniform()));
    if (spots && i % 2) {
      const glm::dvec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3);
      lights.push_back(spot_light(p, axis, 4 * radius, half_angles_deg[i / 2 % 6] * degree));
    } else {
      lights.push_back(point_light(p, radius));
    }
  }
  return lights;
}

// Thin, thick, endless and empty cells.
std::vector<glm::vec2> scattered_intervals(size_t tiles, uint64_t seed) {
  Random random(seed);
  std::vector<glm::vec2> intervals;
  for (size_t i = 0; i < tiles; ++i) {
    const float near = 0.1f * std::exp2(9 * random.uniform());
    switch (random.next() % 6) {
      case 0:
        intervals.emplace_back(far_away, -far_away);
        break;
      case 1:
        intervals.emplace_back(0.0f, far_away);
        break;
      case 2:
        intervals.emplace_back(near, near);
        break;
      case 3:
        intervals.emplace_back(0.1f, near);
        break;
      default:
        intervals.emplace_back(near, near * (1 + random.uniform()));
    }
  }
  return intervals;
}

CullerOptions grid_options(CullTest test, KernelShape shape) {
  CullerOptions options;
  options.cull_test = test;
  options.shape = shape;
  return options;
}

std::vector<CullTest> every_cull_test() {
  std::vector<CullTest> tests;
  for (const CullTestRow& row : cull_tests) tests.push_back(row.test);
  return tests;
}

std::string test_name(CullTest test) {
  std::string name = row_of(test).name;
  std::ranges::replace(name, '+', '_');
  return name;
}

struct LightGridOf : testing::TestWithParam<std::tuple<CullTest, KernelShape>> {
  CullerOptions options = grid_options(std::get<0>(GetParam()), std::get<1>(GetParam()));
};

TEST_P(LightGridOf, ListsWhatCertainlyTouchesAndLittleElse) {
  for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(17, 9), glm::ivec2(127, 73)}) {
    for (const NamedView& named : views(size.x, size.y)) {
      SCOPED_TRACE(fmt::format("{} {}x{}", named.name, size.x, size.y));
      options.pixel_centres = named.inset > 0;
      const auto lights = scattered_lights(named.view, 600, true, 7);
      const auto intervals = scattered_intervals(tile_count(named.view, options.tile), 8);
      const CulledGrid grid = cull_cells(named.view, lights, intervals, options);
      expect_well_formed(grid, lights.size());
      const uint64_t touching = expect_none_lost(named.view, lights, intervals, grid, named.inset);
      if (size.x == 127) {
        EXPECT_GT(touching, 100u);
      }
      if (options.cull_test == CullTest::planes_aabb) expect_little_more(named.view, lights, intervals, grid);
    }
  }
}

TEST_P(LightGridOf, AnyNumberOfLights) {
  options.pixel_centres = false;
  const View view = view_of(127, 73, 60);
  const auto intervals = scattered_intervals(tile_count(view, options.tile), 9);
  const auto most = scattered_lights(view, 257, true, 10);
  for (const int count : {0, 1, 15, 16, 17, 63, 64, 65, 127, 128, 129, 254, 255, 256, 257}) {
    SCOPED_TRACE(count);
    const std::vector<ViewLight> lights(most.begin(), most.begin() + count);
    const CulledGrid grid = cull_cells(view, lights, intervals, options);
    expect_well_formed(grid, lights.size());
    expect_none_lost(view, lights, intervals, grid, 0);
  }
}

// Lights whose range ends exactly on a cell's side, edge or corner, and one unit in the last place past it.
TEST_P(LightGridOf, TangentLightsAreKept) {
  for (const NamedView& named : views(127, 73)) {
    SCOPED_TRACE(named.name);
    options.pixel_centres = named.inset > 0;
    const View& view = named.view;
    const auto intervals = scattered_intervals(tile_count(view, options.tile), 11);
    CulledGrid shape;
    shape.params = cull_params(cull_view_of(view), options.tile);
    Random random(12);
    std::vector<ViewLight> lights;
    while (lights.size() < 4000) {
      const size_t tile = random.next() % intervals.size();
      if (!(intervals[tile].x <= intervals[tile].y)) continue;
      const Cell cell = true_cell(view, shape, tile, intervals[tile], named.inset);
      const double far = std::min(cell.far, 100 * std::max(cell.near, 0.1));
      const auto pick = [&](double low, double high) {  // an end twice in three: corners, edges, sides
        const uint64_t which = random.next() % 3;
        return which == 0 ? low : which == 1 ? high : low + (high - low) * random.uniform();
      };
      const double d = pick(cell.near, far), scale = cell.scale_at(d);
      const glm::dvec3 q(pick(cell.x0, cell.x1) * scale, pick(cell.y0, cell.y1) * scale, -d);
      const double size = (cell.x1 - cell.x0) * scale * std::exp2(8 * random.uniform() - 2);
      const glm::dvec3 centre =
          q + size * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      const double distance = distance_to_cell(cell, centre);
      if (distance == 0) continue;
      float radius = float(distance);
      if (radius < distance) radius = std::nextafter(radius, infinity);
      if (random.next() % 2) radius = std::nextafter(radius, infinity);
      lights.push_back(point_light(centre, radius));
    }
    const CulledGrid grid = cull_cells(view, lights, intervals, options);
    expect_well_formed(grid, lights.size());
    EXPECT_GE(expect_none_lost(view, lights, intervals, grid, named.inset), 4000u);
  }
}

TEST_P(LightGridOf, StrangeLights) {
  for (const NamedView& named : views(127, 73)) {
    SCOPED_TRACE(named.name);
    options.pixel_centres = named.inset > 0;
    const View& view = named.view;
    std::vector<glm::vec2> intervals(tile_count(view, options.tile), glm::vec2(0.1f, 50.0f));
    intervals[0] = {0.1f, far_away};
    const std::vector<ViewLight> lights = {
        point_light({0, 0, -3}, 1e20f),           // 0
        point_light({0, 0, -3}, infinity),        // 1
        point_light({0, 0, 5}, 1),                // 2 behind
        point_light({0, 0, 5}, 5.2),              // 3 behind, and reaches past the near plane
        point_light({0, 0, 0}, 0.5),              // 4 at the eye, and the eye in it
        point_light({0, 0, -0.1}, 0.01),          // 5 across the near plane
        point_light({0, 0, -10}, 0),              // 6 touches the cells that hold its place
        point_light({0, 0, -10}, 1e-40f),         // 7
        point_light({0, 0, -1e7}, 1),             // 8 past what most tiles hold
        point_light({3e18, 0, -1e18}, infinity),  // 9
        spot_light({0, 0, 1}, {0, 0, -1}, infinity, 90 * degree),     // 10
        spot_light({0, 0, -20}, {0, 0, 1}, 1e20f, 120 * degree),      // 11
        spot_light({0, 0, -20}, {1, 0, 0}, infinity, 89.9 * degree),  // 12
    };
    const CulledGrid grid = cull_cells(view, lights, intervals, options);
    expect_well_formed(grid, lights.size());
    expect_none_lost(view, lights, intervals, grid, named.inset);
    for (size_t i = 0; i < grid.cells.size(); ++i) {
      EXPECT_THAT(grid.list(i), testing::IsSupersetOf({0u, 1u, 9u})) << i;
      // The bounding sphere alone reaches anywhere; the interval cuts it off behind the eye.
      EXPECT_THAT(grid.list(i), testing::Not(testing::Contains(2u))) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, LightGridOf,
                         testing::Combine(testing::ValuesIn(every_cull_test()),
                                          testing::Values(KernelShape::lanes, KernelShape::group)),
                         [](const auto& info) {
                           return test_name(std::get<0>(info.param)) +
                                  (std::get<1>(info.param) == KernelShape::lanes ? "_lanes" : "_group");
                         });

TEST(LightGrid, SameBytesInBothShapesAndIndexWidthsAndInEveryRun) {
  const View view = view_of(319, 181, 60);
  const auto lights = scattered_lights(view, 1000, true, 13);
  CullerOptions options = grid_options(CullTest::planes_aabb, KernelShape::lanes);
  const auto intervals = scattered_intervals(tile_count(view, options.tile), 14);
  const CulledGrid first = cull_cells(view, lights, intervals, options);
  EXPECT_GT(first.indices.size(), 1000u);
  for (int run = 0; run < 20; ++run) ASSERT_EQ(cull_cells(view, lights, intervals, options), first) << run;
  options.shape = KernelShape::group;
  EXPECT_EQ(cull_cells(view, lights, intervals, options), first);
  options.index_bits = 32;
  EXPECT_EQ(cull_cells(view, lights, intervals, options), first);
  options.shape = KernelShape::lanes;
  EXPECT_EQ(cull_cells(view, lights, intervals, options), first);
}

TEST(LightGrid, OneCullerGivesTheSameFrameAfterFrame) {
  const View view = view_of(127, 73, 60);
  const auto lights = scattered_lights(view, 300, false, 15);
  const auto intervals = scattered_intervals(tile_count(view, 8), 16);
  CullerOptions options = grid_options(CullTest::planes_aabb, KernelShape::automatic);
  options.tile = 8;
  const CulledGrid first = cull_cells(view, lights, intervals, options);
  LightCuller culler(test_device(), test_programs(), options);
  culler.set_lights(cull_lights_of(lights));
  culler.set_view(cull_view_of(view));
  ClGridStorage storage(test_device());
  std::vector<DepthInterval> given;
  for (const glm::vec2& i : intervals) given.push_back({i.x, i.y});
  const TileBounds bounds = culler.bounds_of(given);
  const TileBounds endless = culler.bounds_of(std::vector<DepthInterval>(intervals.size(), {0, far_away}));
  for (int run = 0; run < 5; ++run) {
    culler.cull(endless, storage);  // another, longer grid in between
    const HostGrid grid = read_grid(test_device(), culler.cull(bounds, storage), storage);
    EXPECT_EQ(grid.cells, first.cells);
    EXPECT_EQ(grid.indices, first.indices);
  }
}

// More candidates and more indices than any first estimate: the grid is still complete.
TEST(LightGrid, GrowsToWhatTheCountsSay) {
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    const View view = view_of(321, 181, 60);
    CullerOptions options = grid_options(CullTest::planes_aabb, shape);
    options.tile = 8;
    const size_t tiles = tile_count(view, options.tile), count = 2000;
    const std::vector<ViewLight> lights(count, point_light({0, 0, -5}, infinity));
    const CulledGrid grid = cull_cells(view, lights, std::vector<glm::vec2>(tiles, {1.0f, 9.0f}), options);
    ASSERT_EQ(grid.grid.index_count, tiles * count);
    expect_well_formed(grid, count);
    for (const glm::uvec2 cell : grid.cells) EXPECT_EQ(cell.y, count);
  }
}

TEST(LightGrid, MoreThanTheDeviceHoldsIsAMachineError) {
  const View view = view_of(321, 181, 60);
  const size_t tiles = tile_count(view, 8), bins = 6 * 3;
  const std::vector<ViewLight> lights(2000, point_light({0, 0, -5}, infinity));
  // Room for the 20-byte candidates of every bin, or not even for those.
  for (const size_t bytes : {bins * lights.size() * 20 + 1000, size_t(200'000)}) {
    ClDevice device;
    const_cast<ClDeviceInfo&>(device.info()).max_allocation_bytes = bytes;
    ProgramCache programs(device);
    CullerOptions options;
    options.tile = 8;
    LightCuller culler(device, programs, options);
    culler.set_lights(cull_lights_of(lights));
    culler.set_view(cull_view_of(view));
    ClGridStorage storage(device);
    EXPECT_THAT(error_of(
                    [&] {
                      culler.cull(culler.bounds_of(std::vector<DepthInterval>(tiles, {1.0f, 9.0f})), storage);
                    },
                    ErrorKind::machine),
                testing::HasSubstr("memory"));
  }
}

// Draws a depth image with about a tenth of the pixels empty.
std::vector<float> depth_with_gaps(const View& view, uint64_t seed) {
  Random random(seed);
  std::vector<float> depth(size_t(view.width) * view.height);
  for (float& value : depth) {
    const float surface = view.orthographic ? random.uniform() : std::exp2(-7 * random.uniform()) * 0.5f;
    value = random.uniform() < 0.1f ? 0.0f : surface;
  }
  return depth;
}

// From a depth image to lists, compared with the lights that reach each pixel's centre. One test a cull test,
// so that two that run at once build different kernels.
struct LightGridUnder : testing::TestWithParam<CullTest> {};

TEST_P(LightGridUnder, NoSettingLosesAPixelsLight) {
  for (const NamedView& named : views(127, 73)) {
    const std::vector<float> depth = depth_with_gaps(named.view, 17);
    const auto lights = scattered_lights(named.view, 400, true, 18);
    const LitBlocks lit = find_lit_blocks(named.view, depth, lights);
    // The two tightest tests under every depth-bounds mode, the others under every second, since each is a
    // kernel to compile. Tile sizes alternate; every sixth setting also runs the other shape.
    const bool every_mode =
        GetParam() == CullTest::planes_aabb || GetParam() == CullTest::exact || long_tests();
    for (int mode = 0; mode < int(std::size(depth_bounds_modes)); ++mode) {
      if (!every_mode && (mode + int(GetParam())) % 2 != 0) continue;
      const int combination = int(std::size(depth_bounds_modes)) * int(GetParam()) + mode,
                tile = 8 << combination % 4;
      CullerOptions options = grid_options(GetParam(), KernelShape::lanes);
      options.tile = tile;
      options.depth_bounds = DepthBoundsMode(mode);
      SCOPED_TRACE(fmt::format("{} mode {} tile {}", named.name, mode, tile));
      const CulledGrid grid = cull_depth(named.view, lights, depth, options);
      ASSERT_EQ(grid.cells.size(), tile_count(named.view, tile));
      expect_well_formed(grid, lights.size());
      if (combination % 6 == 0) {
        options.shape = KernelShape::group;
        EXPECT_EQ(cull_depth(named.view, lights, depth, options), grid);
      }
      ListedLights lists;
      for (const glm::uvec2 cell : grid.cells) {
        lists.first.push_back(cell.x);
        lists.count.push_back(cell.y);
      }
      lists.indices = grid.indices;
      const ListAccuracy accuracy = measure_lists(lit, tile, lists);
      EXPECT_EQ(accuracy.lost, 0u);
      EXPECT_GT(accuracy.lit, 200u);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kernels, LightGridUnder, testing::ValuesIn(every_cull_test()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace lightgrid
