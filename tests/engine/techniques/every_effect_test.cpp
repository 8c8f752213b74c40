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
