// One culler from view to view: earlier views must not affect later ones.
#include <gmock/gmock.h>

#include "base/error.h"
#include "culling/culled_grid.h"
#include "scene/random.h"
#include "shared/cull_tests.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

struct Scene {
  View view;
  std::vector<float> slice_edges;
  std::vector<ViewLight> lights;
};

std::vector<ViewLight> some_lights(int count, bool spots, uint64_t seed) {
  Random random(seed);
  std::vector<ViewLight> lights;
  for (int i = 0; i < count; ++i) {
    const double d = 0.5 + 20 * random.uniform();
    const glm::dvec3 place(d * random.uniform(-1, 1), d * random.uniform(-0.6f, 0.6f), -d);
    lights.push_back(spots && i % 2 ? spot_light(place, {0.3, -1, 0.1}, 4, 0.5)
                                    : point_light(place, 0.2 * d));
  }
  return lights;
}

HostGrid grid_of(LightCuller& culler, const Scene& scene) {
  culler.set_lights(cull_lights_of(scene.lights));
  CullView view = cull_view_of(scene.view);
  view.slice_edges = scene.slice_edges;
  culler.set_view(view);
  const size_t tiles = tile_count(scene.view, 16);
  ClGridStorage storage(test_device());
  const TileBounds bounds = culler.bounds_of(std::vector<DepthInterval>(tiles, {1, 15}));
  return read_grid(test_device(), culler.cull(bounds, storage), storage);
}

struct LightCullerOf : testing::TestWithParam<KernelShape> {
  CullerOptions options{.shape = GetParam()};
};

TEST_P(LightCullerOf, LightsAndViewsThatChangeGiveTheGridsOfAFreshOne) {
  const View small = view_of(127, 73, 60), large = view_of(640, 360, 90);
  const View flat = orthographic_view_of(127, 73, 5, 0, 100);
  const std::vector<float> edges = slice_edges(SliceSpacing::exponential, 8, 0.1, 50);
  const std::vector<Scene> scenes = {
      {small, {}, some_lights(300, false, 1)}, {small, {}, some_lights(300, true, 2)},
      {large, {}, some_lights(1000, true, 3)}, {small, {}, {}},
      {flat, {}, some_lights(17, false, 4)},   {small, edges, some_lights(300, true, 5)},
      {small, {}, some_lights(300, true, 5)},  {large, {}, some_lights(1, false, 6)}};
  LightCuller culler(test_device(), test_programs(), options);
  for (size_t i = 0; i < scenes.size(); ++i) {
    LightCuller fresh(test_device(), test_programs(), options);
    const HostGrid expected = grid_of(fresh, scenes[i]);
    EXPECT_TRUE(grid_of(culler, scenes[i]) == expected) << "scene " << i;
    EXPECT_EQ(expected.indices.empty(), scenes[i].lights.empty()) << "scene " << i;
  }
}

TEST_P(LightCullerOf, SlicesMayComeAndGoWithTheView) {
  const View view = view_of(127, 73, 60);
  const Scene plain{view, {}, some_lights(300, false, 7)};
  LightCuller culler(test_device(), test_programs(), options), fresh(test_device(), test_programs(), options);
  CullView sliced = cull_view_of(view);
  sliced.slice_edges = slice_edges(SliceSpacing::linear, 4, 0.1, 20);
  const HostGrid expected = grid_of(fresh, {view, sliced.slice_edges, plain.lights});
  grid_of(culler, plain);
  culler.set_view(sliced);  // and the same lights
  ClGridStorage storage(test_device());
  const TileBounds bounds = culler.bounds_of(std::vector<DepthInterval>(tile_count(view, 16), {1, 15}));
  EXPECT_TRUE(read_grid(test_device(), culler.cull(bounds, storage), storage) == expected);
}

// Behind the eye, too, once the view is orthographic.
TEST_P(LightCullerOf, WithoutDepthBoundsTilesReachAsFarAsTheViewDoes) {
  options.depth_bounds = DepthBoundsMode::none;
  LightCuller culler(test_device(), test_programs(), options);
  culler.set_view(cull_view_of(view_of(127, 73, 60)));
  EXPECT_EQ(culler.read_bounds(culler.depth_bounds({}).opaque)[0], (DepthInterval{0, 1e18f}));
  culler.set_view(cull_view_of(orthographic_view_of(127, 73, 5, 0, 100)));
  EXPECT_EQ(culler.read_bounds(culler.depth_bounds({}).opaque)[0], (DepthInterval{-1e18f, 1e18f}));
}

INSTANTIATE_TEST_SUITE_P(Shapes, LightCullerOf, testing::Values(KernelShape::lanes, KernelShape::group),
                         [](const auto& info) {
                           return info.param == KernelShape::lanes ? "lanes" : "group";
                         });

TEST(LightCuller, ChoosesTheShapeFromTheDevice) {
  const LightCuller culler(test_device(), test_programs(), {});
  EXPECT_EQ(culler.shape(), test_device().info().cpu ? KernelShape::lanes : KernelShape::group);
}

// Radii that reach nothing, in front of every pixel.
TEST(LightCuller, RefusesOptionsThatAreNone) {
  const auto message_of = [](const CullerOptions& options) -> std::string {
    try {
      const LightCuller culler(test_device(), test_programs(), options);
      return "";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::input);
      return error.what();
    }
  };
  EXPECT_EQ(message_of({.tile = 12}), "culler options: tile is 12, not one of 8, 16, 32, 64");
  EXPECT_THAT(message_of({.tile = 0}), testing::HasSubstr("tile is 0"));
  EXPECT_THAT(message_of({.samples = 3}), testing::HasSubstr("samples is 3, not one of 1, 2, 4, 8"));
  EXPECT_THAT(message_of({.index_bits = 8}), testing::HasSubstr("index_bits is 8"));
  EXPECT_THAT(message_of({.group_size = 2048}), testing::HasSubstr("group_size is 2048"));
  EXPECT_THAT(message_of({.cull_test = CullTest(std::size(cull_tests))}),
              testing::HasSubstr("cull_test is " + std::to_string(std::size(cull_tests))));
  EXPECT_THAT(message_of({.depth_bounds = DepthBoundsMode(-1)}), testing::HasSubstr("depth_bounds is -1"));
  EXPECT_THAT(message_of({.shape = KernelShape(3)}), testing::HasSubstr("shape is 3"));
  EXPECT_THAT(message_of({.depth_format = DepthFormat(3)}), testing::HasSubstr("depth_format is 3"));
  EXPECT_THAT(message_of({.lists = GridLists(2)}), testing::HasSubstr("lists is 2"));
  EXPECT_EQ(message_of({}), "");
}

// More lights, and more candidates of a block, than any group processes at once (culling/gpu/cull_lights.cl).
TEST(LightCuller, GivesTheSameGridWithAnyGroupSize) {
  const View view = view_of(127, 73, 60);
  std::vector<ViewLight> lights;
  for (int i = 0; i < 70000; ++i)
    lights.push_back(point_light({0.01 * (i % 100) - 0.5, 0.002 * (i % 37), -1 - 0.0004 * i}, 0.2));
  const std::vector<glm::vec2> intervals(tile_count(view, 16), {1, 9});
  const CulledGrid lanes = cull_cells(view, lights, intervals, {.shape = KernelShape::lanes});
  for (const int size : {0, 64, 128, 256, 512, 1024}) {
    EXPECT_EQ(cull_cells(view, lights, intervals, {.shape = KernelShape::group, .group_size = size}), lanes)
        << size;
  }
}

// As on a device whose work-groups are smaller than usual.
TEST(LightCuller, FitsItsGroupsToTheDevice) {
  const View view = view_of(127, 73, 60);
  const std::vector<CullLight> lights = cull_lights_of(some_lights(300, false, 8));
  const std::vector<float> depth(127 * 73, 0.02f);
  const auto grid_with = [&](size_t max_items) {
    ClDevice device;
    ProgramCache programs(device);
    const_cast<ClDeviceInfo&>(device.info()).max_group_items = max_items;
    const cl::Buffer values(device.context(), CL_MEM_COPY_HOST_PTR, depth.size() * sizeof(float),
                            const_cast<float*>(depth.data()));
    LightCuller culler(device, programs, {.shape = KernelShape::group});
    culler.set_lights(lights);
    culler.set_view(cull_view_of(view));
    ClGridStorage storage(device);
    return read_grid(device, culler.cull(culler.depth_bounds({values}).opaque, storage), storage);
  };
  const HostGrid usual = grid_with(1024);
  EXPECT_FALSE(usual.indices.empty());
  EXPECT_TRUE(grid_with(128) == usual);
  EXPECT_THAT(error_of([&] { grid_with(64); }, ErrorKind::machine),
              testing::HasSubstr("work-groups of 128 items"));
}

// So many tiles that 64 regions would be wider than the 128 tiles that a byte can distinguish
// (packed_range.h).
TEST(LightCuller, FindsSmallLightsAmongTwoMillionTiles) {
  const View view = view_of(16400, 8300, 60);
  const int tile = 8, tiles_x = 2050, tiles_y = 1038;
  const glm::dmat4 view_from_clip = glm::inverse(view.clip_from_view);
  Random random(31);
  std::vector<ViewLight> lights;
  std::vector<size_t> cells;
  for (int i = 0; i < 500; ++i) {
    const int x = int(random.uniform() * (tiles_x - 1)), y = int(random.uniform() * (tiles_y - 1));
    const glm::dvec4 clip((x + 0.5) * tile / 8200 - 1, (y + 0.5) * tile / 4150 - 1, 0.5, 1);
    const glm::dvec4 place = view_from_clip * clip;
    lights.push_back(point_light(glm::dvec3(place) * (5 / -place.z), 1e-4));
    cells.push_back(size_t(y) * tiles_x + x);
  }
  const std::vector<glm::vec2> intervals(tile_count(view, tile), {1, 15});
  const CulledGrid grid = cull_cells(view, lights, intervals, {.shape = KernelShape::lanes, .tile = tile});
  EXPECT_EQ(grid.params.region_bins, 16u);
  EXPECT_GT(grid.params.regions_x * grid.params.regions_y, 64u);
  for (uint32_t i = 0; i < lights.size(); ++i)
    EXPECT_THAT(grid.list(cells[i]), testing::Contains(i)) << cells[i];
  EXPECT_EQ(grid.indices.size(), lights.size());  // each in the middle of its tile
}

// Unlike GCC 12.2, which computed the second floats of y and z as 0: docs/devices.md#known-faults.
TEST(LightCuller, KeepsWhatFloatLeavesOfTheEyesPlace) {
  LightCuller culler(test_device(), test_programs(), {});
  culler.set_lights(std::vector<CullLight>{{{0.1, -5.2345678901234, 9.385133093691941}, 1}});
  culler.set_view(cull_view_of(view_of(64, 48, 60)));
  const CullParams p = culler.read_inputs(culler.bounds_of({})).params;
  EXPECT_NEAR(double(p.eye_x) + p.eye_rest_x, -0.1, 1e-15);
  EXPECT_NEAR(double(p.eye_y) + p.eye_rest_y, 5.2345678901234, 1e-13);
  EXPECT_NEAR(double(p.eye_z) + p.eye_rest_z, -9.385133093691941, 1e-13);
}

TEST(LightCuller, ListsLightsOfNegativeOrNanRadiusNowhere) {
  const View view = view_of(127, 73, 60);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<ViewLight> lights = {point_light({0, 0, -3}, -1), point_light({0, 0, -3}, nan),
                                         point_light({0, 0, -3}, -INFINITY), point_light({0, 0, -3}, 100)};
  const std::vector<glm::vec2> intervals(tile_count(view, 16), {1, 9});
  for (const KernelShape shape : {KernelShape::lanes, KernelShape::group}) {
    const CulledGrid grid = cull_cells(view, lights, intervals, {.shape = shape});
    for (size_t i = 0; i < grid.cells.size(); ++i) EXPECT_THAT(grid.list(i), testing::ElementsAre(3)) << i;
  }
}

}  // namespace
}  // namespace lightgrid
