// Lights that are too dim for a shadow (shadow-threshold): the picture differs by less than the steps of the
// display that the setting says.
#include <gmock/gmock.h>

#include <numbers>

#include "base/image.h"
#include "plan/dim_lights.h"
#include "plan/settings/picture.h"
#include "plan/settings/shadows.h"
#include "support/random_rooms.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

// In steps, before they are rounded to bytes.
double largest_step(const Image& a, const Image& b, double ev) {
  const float scale = Exposure{ev}.scale();
  double most = 0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const glm::vec3 one = tone_map_neutral(scale * glm::vec3(a.pixels[i])),
                    other = tone_map_neutral(scale * glm::vec3(b.pixels[i]));
    for (int c = 0; c < 3; ++c)
      most = std::max(most,
                      255 * std::abs(double(srgb_from_linear(one[c])) - double(srgb_from_linear(other[c]))));
  }
  return most;
}

TEST(DimLights, MoveNoPixelByMoreThanTheyMay) {
  Random random(5);
  for (const int threshold : {1, 16}) {
    double most = 0, told = 0;
    size_t dim = 0, shadowed = 0;
    for (int i = 0; i < 25; ++i) {
      RandomRoom room = random_room(random, 45, 31);
      const double ev = i % 3 - 1;
      // Brightnesses lie around the threshold.
      for (Light& light : room.scene.lights)
        light.intensity *= float(display_step(ev) * threshold * std::exp2(double(random.uniform(-6, 4))));
      Settings settings;
      settings.set(setting::display_ev, ev);
      settings.set(setting::shadow_threshold, threshold);
      if (i % 4 == 0) apply_setting(settings, "brdf=lambert");
      if (i % 5 == 0) apply_setting(settings, "window=smooth");
      GpuScene gpu(test_devices(), room.scene);
      TechniqueRun run(test_devices(), gpu, room.view, settings, find_technique("visibility"));
      run.run_frame();
      settings.set(setting::shadow_threshold, 0);
      TechniqueRun exact(test_devices(), gpu, room.view, settings, find_technique("visibility"));
      exact.run_frame();
      const FramePlan& plan = run.view().plan;
      const double here = largest_step(run.image(), exact.image(), ev);
      EXPECT_LE(here, plan.shadows.dim_steps) << "room " << i;
      EXPECT_LT(plan.shadows.dim_steps, threshold) << "room " << i;
      most = std::max(most, here);
      told = std::max(told, plan.shadows.dim_steps);
      dim += size_t(std::ranges::count(plan.shadows.casting, ShadowNeed::too_dim, &LightShadow::need));
      shadowed += size_t(std::ranges::count(plan.shadows.casting, ShadowNeed::rays, &LightShadow::need));
      EXPECT_EQ(run.result().shadows->dim_steps, plan.shadows.dim_steps);
    }
    EXPECT_GT(dim, 15u) << threshold;
    EXPECT_GT(shadowed, 15u) << threshold;
    EXPECT_GT(most, 0.001);
    EXPECT_GT(told, 0.9 * threshold);
  }
}

// The bound on the tone map's slope, and that of sRGB: where a picture begins, and how light is added.
TEST(DimLights, AStepIsTheLeastThatLightTakes) {
  Random random(3);
  double most = 0;
  for (int i = 0; i < 200'000; ++i) {
    const double scale = std::exp2(double(random.uniform(-14, 3)));
    const auto color = [&](double of) {
      return glm::vec3(of * random.uniform(0, 1), of * random.uniform(0, 1), of * random.uniform(0, 1));
    };
    Image before(1, 1), after(1, 1);
    const glm::vec3 from = color(scale), added = color(1);
    const double step = 0.25 * display_step(0);
    before.pixels[0] = glm::vec4(i % 7 ? from : glm::vec3(from.x, 0, 0), 1);
    after.pixels[0] = before.pixels[0] + glm::vec4(float(step) * added, 0);
    most = std::max(most, largest_step(before, after, 0));
  }
  EXPECT_LE(most, 0.25 * 1.001);
  EXPECT_GT(most, 0.1);
}

// A wall in the dark, and a red lamp 1 m before it, behind a chip.
struct DarkWall {
  Scene scene;
  View view = small_view(45, 31);

  DarkWall() {
    SmallScene s = small_scene(false);
    scene = s.scene;
    scene.background = scene.ambient = {0, 0, 0};
    scene.instances.resize(1);
    // Not lit, and seen from behind, where it is not drawn.
    const int plain = add_material(scene, "plain", {1, 1, 1}, 0, 1);
    scene.materials[size_t(plain)].unlit = true;
    Mesh chip = wall_mesh({0, 0, -3.5f}, 0.1f, plain, "chip");
    for (size_t i = 0; i < chip.indices.size(); i += 3) std::swap(chip.indices[i], chip.indices[i + 1]);
    add_instance(scene, "chip", add_mesh(scene, std::move(chip)));
    add_point(scene, "lamp", {0, 0, -3}, {1, 0, 0}, 1, 3).casts_shadow = true;
  }
  // Lambert's bound on one of these lamps, in steps of the display.
  double steps() const { return 0.7 / std::numbers::pi * (1 - std::pow(1 / 3.0, 4)) / display_step(0); }
};

// The bound is near what a lamp adds that shines straight onto a wall.
TEST(DimLights, ABoundIsNotMuchTooWide) {
  DarkWall dark;
  dark.scene.lights[0].intensity = float(0.98 / dark.steps());
  Settings settings;
  apply_setting(settings, "brdf=lambert");
  const Image exact = render(dark.scene, dark.view, "visibility", settings);
  settings.set(setting::shadow_threshold, 1);
  const double moved = largest_step(render(dark.scene, dark.view, "visibility", settings), exact, 0);
  EXPECT_LT(moved, 1);
  EXPECT_GT(moved, 0.75);
}

TEST(DimLights, ManyOfThemTogetherAddNoMoreThanOneMay) {
  DarkWall dark;
  Settings settings;
  apply_setting(settings, "brdf=lambert");
  settings.set(setting::shadow_threshold, 4);
  const auto dim = [&](double share_of_a_step) {
    Light light = dark.scene.lights.at(0);
    light.intensity = float(share_of_a_step / dark.steps());
    dark.scene.lights.assign(40, light);
    const FramePlan plan = plan_frame(dark.scene, dark.view, settings, {});
    return std::ranges::count(plan.shadows.casting, ShadowNeed::too_dim, &LightShadow::need);
  };
  EXPECT_EQ(dim(0.9), 4);
  EXPECT_EQ(dim(0.09), 40);
  EXPECT_EQ(dim(0.12), 33);
  EXPECT_EQ(dim(3.9), 1);
  EXPECT_EQ(dim(4.1), 0);
}

TEST(DimLights, NeedAnExposureThatIsKnown) {
  Random random(9);
  const RandomRoom room = random_room(random, 45, 31);
  Settings settings;
  settings.set(setting::shadow_threshold, 1);
  settings.set(setting::display_ev, std::nullopt);
  EXPECT_THROW(plan_frame(room.scene, room.view, settings, {}), Error);
  settings.set(setting::shadow_threshold, 0);
  EXPECT_NO_THROW(plan_frame(room.scene, room.view, settings, {}));
}

TEST(DimLights, WhatHasNoBoundIsNeverTooDim) {
  Random random(9);
  RandomRoom room = random_room(random, 45, 31);
  EXPECT_LT(max_reflected(room.scene, 0, Brdf::ggx), 10);
  EXPECT_LT(max_reflected(room.scene, 0, Brdf::lambert), max_reflected(room.scene, 0, Brdf::ggx));
  Material& m =
      room.scene.materials[size_t(room.scene.meshes[size_t(room.scene.instances[0].mesh)].material)];
  m.clearcoat = 0.1f;
  EXPECT_TRUE(std::isinf(max_reflected(room.scene, 0, Brdf::ggx)));
  m.clearcoat = 0;
  m.specular = 0.5f;
  EXPECT_TRUE(std::isinf(max_reflected(room.scene, 0, Brdf::ggx)));
  m.specular = 1;
  m.unlit = true;
  EXPECT_EQ(max_reflected(room.scene, 0, Brdf::ggx), 0);
}

}  // namespace
}  // namespace lightgrid
