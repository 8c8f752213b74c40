// The scene that needs every effect of engine/effects: gallery with assets/profiles/gallery.json
// (docs/scenes.md#a-scene-with-every-effect).
#include <gmock/gmock.h>

#include "effects/effects.h"
#include "run/scene_choice.h"
#include "support/paths.h"
#include "techniques/against_the_oracle.h"

namespace lightgrid {
namespace {

const ChosenScene& gallery() {
  static const ChosenScene chosen = [] {
    SceneChoice choice;
    choice.scene = "gallery";
    choice.lights_file = std::string(source_folder) + "/assets/profiles/gallery.json";
    choice.environment = "sky:0.02,0.03,0.06,0.05,0.05,0.06,0.03,0.02,0.02";
    choice.size = "48x27";
    return load_chosen_scene(choice);
  }();
  return chosen;
}

TEST(EveryEffect, IsNamedWithItsWitness) {
  TechniqueRun run(test_devices(), gallery().scene, gallery().view, assigned("far-light=4096"),
                   find_technique("visibility"));
  const FramePlan& plan = run.view().plan;
  EXPECT_EQ(plan.effects.size(), all_effects.size());
  const std::string text = describe(plan, gallery().scene);
  for (const Effect* effect : all_effects) {
    std::string name = effect->name;
    std::ranges::replace(name, '_', ' ');
    EXPECT_THAT(text, testing::ContainsRegex("yes " + name + ": [a-z]")) << name;
  }
  EXPECT_THAT(text, testing::HasSubstr("yes shadows: light 0 \"panel\""));
}

TEST(EveryEffect, TogetherAreTheOracles) { expect_the_oracles(gallery().scene, gallery().view); }

TEST(EveryEffect, HasTheSameBytesInAllKernels) {
  const auto drawn = [](const std::string& how) {
    return render(gallery().scene, gallery().view, "visibility", assigned("far-light=4096 " + how));
  };
  const Image lanes = drawn("kernel-shape=lanes");
  EXPECT_GT(brightest_channel(lanes), 0.01f);
  for (const char* others : {"kernel-shape=group", "portable=on", "tile=8", "lights=all"})
    EXPECT_TRUE(identical(drawn(others), lanes)) << others;
}

TEST(EveryEffect, FollowsTheCameraAndTheLights) {
  const Settings far = assigned("far-light=4096");
  for (const char* technique : {"forward_plus", "visibility"}) {
    Scene scene = gallery().scene;
    GpuScene gpu(test_devices(), scene);
    TechniqueRun run(test_devices(), gpu, gallery().view, far, find_technique(technique));
    run.run_frame();
    const View turned = make_view(scene.cameras.back(), 48, 27);
    run.look(turned);
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(scene, turned, technique, far))) << technique;
    SceneChanges changes;
    for (int i = 0; i < int(scene.lights.size()); ++i) changes.lights.push_back(i);
    for (Light& light : scene.lights)
      light.direction = glm::normalize(light.direction + glm::vec3(0.3f, 0.1f, 0));
    gpu.update(changes);
    run.look(turned, changes);
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(scene, turned, technique, far))) << technique;
  }
}

// Positions from a depth buffer differ by a rounding, which moves the points of an area light: alone, the two panels
// differ by 1.16e-5, and the other lights by at most 1.6e-7.
constexpr double of_stored_positions = 2e-5;

struct EveryEffectOf : testing::TestWithParam<const Technique*> {};

TEST_P(EveryEffectOf, IsThatOfForward) {
  if (GetParam()->approximate) GTEST_SKIP() << "draws another picture";
  const Settings settings = assigned("far-light=4096");
  static const Image forward = render(gallery().scene, gallery().view, "forward", settings);
  expect_close(gallery().scene, gallery().view, settings, forward, GetParam()->name, of_stored_positions);
}

INSTANTIATE_TEST_SUITE_P(Techniques, EveryEffectOf, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

}  // namespace
}  // namespace lightgrid
