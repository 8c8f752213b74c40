// z-bins: shading passes over lights of its list, and the image keeps the bytes of every light at every pixel.
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

struct BuiltinZBins : testing::TestWithParam<const char*> {
  const Scene scene = find_builtin_scene(GetParam())->make();
};

TEST_P(BuiltinZBins, HaveTheBytesOfEveryLightAtEveryPixelThroughEveryCamera) {
  for (const Camera& camera : scene.cameras) {
    SCOPED_TRACE(camera.name);
    const View view = make_view(camera, 95, 53);
    const Image forward = render(scene, view, "forward");
    expect_exact(scene, view, {.z_bins = 64}, forward);
    expect_exact(scene, view, {.z_bins = 256}, forward, "clustered");
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinZBins, testing::Values("hall", "spheres", "terrain", "street"),
                         [](const auto& info) { return std::string(info.param); });

SmallScene scene_with_glass() {
  SmallScene s = small_scene();
  for (const Effect& effect : effects()) {
    if (effect.name == "blend" || effect.name == "spot") effect.add(s);
  }
  for (int i = 0; i < 60; ++i) {
    add_point(s.scene, "lamp", {0.05f * i - 1.5f, 0.3f, -3.9f + 0.03f * i}, {1, 1, 1}, 0.3f, 0.2f + 0.01f * i);
  }
  return s;
}

TEST(ZBins, HaveTheBytesWithGlassMasksLinearBinsAndNoDepthBounds) {
  const Scene scene = scene_with_glass().scene;
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.orthographic = true;
  camera.half_width_m = camera.half_height_m = 2;
  camera.near_m = -3, camera.far_m = 10;
  for (const View& view : {small_view(127, 73), small_view(1, 1), make_view(camera, 127, 73)}) {
    const Image forward = render(scene, view, "forward");
    for (const Settings& settings :
         {Settings{.slice_spacing = SliceSpacing::linear, .z_bins = 16},
          Settings{.z_bins = 256, .grid_lists = GridLists::masks},
          Settings{.depth_bounds = DepthBoundsMode::none, .z_bins = 64, .kernel_shape = KernelShape::group}}) {
      SCOPED_TRACE(testing::PrintToString(to_strings(settings)));
      expect_exact(scene, view, settings, forward);
      expect_exact(scene, view, settings, forward, "clustered");
    }
  }
}

uint64_t listed(const Scene& scene, const View& view, const Settings& settings) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("forward_plus"));
  run.run_frame();
  return count_listed_pairs(run, read_depth(run.frame())).listed;
}

TEST(ZBins, PassOverMoreTheFinerTheyAre) {
  const Scene scene = find_builtin_scene("spheres")->make();
  const View view = default_view(scene, 160, 90);
  const uint64_t off = listed(scene, view, {}), coarse = listed(scene, view, {.z_bins = 16});
  const uint64_t fine = listed(scene, view, {.z_bins = 64}), finest = listed(scene, view, {.z_bins = 256});
  EXPECT_LT(coarse, off / 2);  // tiles with a sphere before a far floor
  EXPECT_LT(fine, coarse);
  EXPECT_LT(finest, fine);
  EXPECT_EQ(listed(scene, view, {.z_bins = 64, .grid_lists = GridLists::masks}), fine);
}

TEST(ZBins, AreNeitherBuiltNorKeptWhereTheyAreOff) {
  const Scene scene = small_scene().scene;
  const View view = small_view(17, 9);
  TechniqueRun off(test_devices(), scene, view, {}, find_technique("forward_plus"));
  TechniqueRun on(test_devices(), scene, view, {.z_bins = 16}, find_technique("forward_plus"));
  off.run_frame(), on.run_frame();
  EXPECT_EQ(off.frame().opaque_grid_last.z_bin_bytes, 0u);
  EXPECT_EQ(on.frame().opaque_grid_last.z_bin_bytes, 4 * on.frame().plan.local.size());
  EXPECT_FALSE(off.frame().opaque_grid().z_bins_.buffer);
}

}  // namespace
}  // namespace lightgrid
