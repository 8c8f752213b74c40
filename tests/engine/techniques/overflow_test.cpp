// Radiance past float's range: pixels are infinite and counted, and none is NaN.
#include "plan/settings/surfaces.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// Lights of the largest float, one with black channels, whose ranges and cones end within the picture, one of
// them at the wall itself, one behind it; and a distant light, on a scene with a pane of glass.
Scene blinding_scene() {
  SmallScene s = small_scene(false);
  effect("blend").add(s);
  for (int i = 0; i < 3; ++i)
    add_point(s.scene, "lamp", {i - 1.0f, 0.1f, -3.9f}, {1, 0.9f, 0}, 3.4e38f, 0.5f);
  add_point(s.scene, "at the wall", {0.2f, 0.5f, -4}, {1, 1, 1}, 3.4e38f, 0.3f);
  add_point(s.scene, "behind", {-1, 0.5f, -4.1f}, {1, 1, 1}, 3.4e38f, 0.3f);
  add_spot(s.scene, "torch", {1.2f, 0.5f, -3.5f}, {1.5f, 0.5f, -4}, {1, 1, 0}, 3.4e38f, 1, 10, 25);
  add_point(s.scene, "parked", {3e38f, 0, 0}, {1, 1, 1}, 3.4e38f, 1);
  s.scene.materials[s.ball_material].base_color = {0, 0, 0, 1};
  const int clear = add_material(s.scene, "clear", {1, 1, 1}, 0, 0.5f);
  s.scene.materials[clear].base_color.a = 0;
  s.scene.materials[clear].alpha_mode = AlphaMode::blend;
  add_instance(s.scene, "clear", add_mesh(s.scene, wall_mesh({0, 0, -3.8f}, 0.7f, clear, "clear")));
  return s.scene;
}

TEST(Overflow, IsInfiniteNeverNanInEachKindOfTechnique) {
  const Scene scene = blinding_scene();
  const View view = small_view(127, 73);
  const Image forward = render(scene, view, "forward");
  EXPECT_GT(count_inf_pixels(forward), 20u);
  EXPECT_LT(count_inf_pixels(forward), 127u * 73 / 2) << "ranges end";
  EXPECT_EQ(count_nan_pixels(forward), 0u);
  for (const char* technique :
       {"forward_plus", "forward_plus_compute", "deferred", "deferred_tiled", "clustered", "lidr"}) {
    TechniqueRun run(test_devices(), scene, view, {}, find_technique(technique));
    run.run_frame();
    EXPECT_EQ(count_nan_pixels(run.image()), 0u) << technique;
    EXPECT_EQ(run.result().inf_pixels, count_inf_pixels(forward)) << technique;
  }
  EXPECT_TRUE(identical(render(scene, view, "forward_plus"), forward));
}

// Alpha is exactly 1 there, so that nothing behind a pane may show, however bright, nor as infinity times 0.
TEST(Overflow, BehindABlendedSurfaceOfAlpha1DoesNotCount) {
  Scene scene = blinding_scene();
  const int pane = add_material(scene, "opaque pane", {0.5f, 0.4f, 0.3f}, 0, 0.5f);
  scene.materials[pane].alpha_mode = AlphaMode::blend;
  scene.materials[pane].unlit = true;
  scene.materials[pane].double_sided = true;
  // The bright spots, under one pane, two panes, and a pane and glass.
  for (const float z : {-3.7f, -3.6f}) {
    const Mesh mesh = wall_mesh({z == -3.7f ? -0.5f : 0.3f, 0, z}, 1.1f, pane, "pane");
    add_instance(scene, "pane", add_mesh(scene, mesh));
  }
  const View view = small_view(63, 37);
  Scene dark = scene;
  dark.lights.clear();
  for (const Technique* technique : techniques()) {
    for (const RasterApi raster : {RasterApi::opengl, RasterApi::opencl}) {
      SCOPED_TRACE(fmt::format("{} {}", technique->name, int(raster)));
      const Settings settings{{setting::raster, raster}};
      const Image image = render(scene, view, technique->name, settings);
      EXPECT_EQ(count_nan_pixels(image), 0u);
      const Image without = render(dark, view, technique->name, settings);
      size_t panes = 0;
      for (size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::vec4 shown = without.pixels[i];
        if (shown != glm::vec4(0.5f, 0.4f, 0.3f, 1)) continue;
        ++panes;
        EXPECT_EQ(image.pixels[i], shown);
      }
      EXPECT_GT(panes, 80u);
    }
  }
}

TEST(Overflow, ALightWithoutARangeFromBeyondTheSquareOfFloatAddsNothing) {
  SmallScene s = small_scene();
  const View view = small_view(127, 73);
  const Image without = render(s.scene, view, "forward");
  for (const double far : {1e20, 3e38}) {
    Light& light = s.scene.lights.emplace_back();
    light.name = "parked";
    light.position = {far, -far, 1};
    light.intensity = 10;
  }
  const Image with = render(s.scene, view, "forward");
  EXPECT_EQ(count_nan_pixels(with), 0u);
  EXPECT_TRUE(identical(with, without));
}

TEST(Overflow, ALightAtTheSurfaceItselfIsDarkThereAlone) {
  SmallScene s = small_scene(false);
  s.scene.ambient = glm::vec3(0);
  s.scene.instances.pop_back();  // the wall alone
  // In the middle pixel of an odd number, where the axis meets the wall at z = -4 exactly.
  add_point(s.scene, "in the wall", {0, 0, -4}, {1, 1, 1}, 1, 1);
  const Image image = render(s.scene, small_view(33, 17), "forward");
  EXPECT_EQ(count_nan_pixels(image) + count_inf_pixels(image), 0u);
}

}  // namespace
}  // namespace lightgrid
