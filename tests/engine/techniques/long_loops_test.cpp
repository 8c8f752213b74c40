// More lights than the iterations after which llvmpipe ends a shader's loops (65,535): no sum may lack a
// light in silence.
#include "plan/settings/grid.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// The small scene's six lights behind 70,000 others: in view, before every surface, and reaching none.
Scene with_many_lights() {
  const SmallScene s = small_scene();
  Scene scene = s.scene;
  scene.lights.clear();
  for (int i = 0; i < 70000; ++i)
    add_point(scene, "spark", {0.001f * float(i % 100) - 0.05f, 0.001f * float(i / 100 % 100) - 0.05f, -1},
              {1, 1, 1}, 1, 1e-3f);
  scene.lights.insert(scene.lights.end(), s.scene.lights.begin(), s.scene.lights.end());
  return scene;
}

// One list for many pixels, with all lights in it.
Settings one_long_list() {
  Settings settings;
  settings.set(setting::tile, 64);
  settings.set(setting::depth_bounds, DepthBoundsMode::none);
  return settings;
}

struct LongLoops : testing::Test {
  const View view = small_view(32, 24);
  const Image six_lights = render(small_scene().scene, view, "forward");
  const Scene scene = with_many_lights();
};

TEST_F(LongLoops, OverAllLightsAreWhole) {
  EXPECT_TRUE(identical(render(scene, view, "forward"), six_lights));
}

TEST_F(LongLoops, OverAListAreWhole) {
  TechniqueRun run(test_devices(), scene, view, one_long_list(), find_technique("forward_plus"));
  run.run_frame();
  ASSERT_GE(count_listed_pairs(run, read_depth(run)).listed, uint64_t(32 * 24 / 2) * 70006);
  EXPECT_TRUE(identical(run.image(), six_lights));
}

// A mask's loop takes an iteration a light: where the driver ends it, pixels are NaN.
TEST_F(LongLoops, OverMasksAreWholeOrNaN) {
  Settings settings = one_long_list();
  settings.set(setting::grid_lists, GridLists::masks);
  const Image image = render(scene, view, "forward_plus", settings);
  size_t whole = 0, not_a_number = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    whole += image.pixels[i] == six_lights.pixels[i];
    not_a_number += std::isnan(image.pixels[i].r);
  }
  EXPECT_EQ(whole + not_a_number, image.pixels.size());
}

}  // namespace
}  // namespace lightgrid
