// world_grid: forward's picture to the bit from lists of every shape, shared by views, and rebuilt when
// lights move.
#include <optional>

#include "base/error.h"
#include "passes/common/world_grid_settings.h"
#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

constexpr WorldGridShape shapes[] = {WorldGridShape::cubes, WorldGridShape::columns, WorldGridShape::hashed};

int builds_of(const TechniqueRun& run) {
  int builds = 0;
  for (const PassResult& pass : run.result().passes) builds += pass.name == "build_world_grid";
  return builds;
}

TEST(WorldGridTechnique, IsForwardsPictureToTheBit) {
  SmallScene s = small_scene();
  for (const SceneEffect& effect : effects()) effect.add(s);
  add_point(s.scene, "everywhere", {0, 1, 30}, {1, 0.5f, 0.2f}, 40, std::numeric_limits<float>::infinity());
  const View view = small_view(47, 31);
  const Image forward = render(s.scene, view, "forward");
  for (const WorldGridShape shape : shapes) {
    expect_exact(s.scene, view, {{setting::world_grid, shape}}, forward, "world_grid");
  }
}

TEST(WorldGridTechnique, SharesListsAmongViewsAndFollowsLights) {
  Scene scene = find_builtin_scene("hall")->make();
  GpuScene gpu(test_devices(), scene);
  const View views[] = {default_view(scene, 79, 45), make_view(look_at({3, 2, 1}, {0, 1, -20}), 64, 48)};
  TechniqueRun first(test_devices(), gpu, views[0], {}, find_technique("world_grid"));
  TechniqueRun second(test_devices(), gpu, views[1], {}, find_technique("world_grid"));
  const auto expect_forwards = [&](TechniqueRun& run, const View& view) {
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(scene, view, "forward")));
  };
  const std::shared_ptr<SharedWorldGrid> grid =
      gpu.world_grid(test_devices(), {WorldGridShape::cubes, std::nullopt, 16, ranges_of(Settings())});
  expect_forwards(first, views[0]);
  expect_forwards(second, views[1]);
  first.look(views[1]);
  expect_forwards(first, views[1]);
  EXPECT_EQ(grid->builds(), 1) << "one build serves three views";
  EXPECT_EQ(builds_of(first), 0) << "passes are not timed";
  first.run_profiled_frames(0);
  EXPECT_EQ(builds_of(first), 1) << "timed with the passes";

  const int before = grid->builds();
  SceneChanges changes;
  for (int i = 0; i < int(scene.lights.size()); i += 2) {
    scene.lights[size_t(i)].position += glm::dvec3(0.7, 0.3, -0.4);
    changes.lights.push_back(i);
  }
  gpu.update(changes);
  first.look(views[0], changes);
  second.look(views[1], changes);
  expect_forwards(first, views[0]);
  expect_forwards(second, views[1]);
  EXPECT_EQ(grid->builds(), before + 1) << "one build for both views";

  // Few lights: what changed is updated, once for both, also after a move that no view drew.
  EXPECT_EQ(grid->updates(), 0);
  changes.lights = {3, 100};
  for (int twice = 0; twice < 2; ++twice) {
    for (const int i : changes.lights) scene.lights[size_t(i)].position += glm::dvec3(-0.4, 0.6, 0.5);
    gpu.update(changes);
    changes.lights = {7, 100, 230};
  }
  first.look(views[0], changes);
  second.look(views[1], changes);
  expect_forwards(first, views[0]);
  expect_forwards(second, views[1]);
  EXPECT_EQ(grid->builds(), before + 1);
  EXPECT_EQ(grid->updates(), 1);
}

// The same triangles and the same sums as visibility with every light.
TEST(WorldGridTechnique, InOpenClIsVisibilitysPictureOfEveryLight) {
  SmallScene s = small_scene();
  s.scene.materials[size_t(s.ball_material)].alpha_mode = AlphaMode::blend;
  s.scene.materials[size_t(s.ball_material)].base_color.a = 0.5f;
  const View view = small_view(47, 31);
  const Image every = render(s.scene, view, "visibility", {{setting::lights, ShadedLights::all}});
  for (const WorldGridShape shape : shapes) {
    TechniqueRun run(test_devices(), s.scene, view,
                     {{setting::raster, RasterApi::opencl}, {setting::world_grid, shape}},
                     find_technique("world_grid"));
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), every));
    EXPECT_EQ(count_listed_pairs(run, read_depth(run)).lost, 0u);
  }
}

}  // namespace
}  // namespace lightgrid
