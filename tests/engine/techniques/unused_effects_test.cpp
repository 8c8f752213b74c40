// Effects that a scene does not need cost nothing: a technique's programs, passes, bytes, memory and pictures
// are those of a technique without the effects. The texts of the programs are compared by
// tests/texts/check_texts.py.
#include <gmock/gmock.h>

#include <map>
#include <string>

#include "effects/effects.h"
#include "support/small_scene.h"
#include "support/technique_tiers.h"
#include "techniques/observed_run.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

Technique without_effects(const Technique& technique) {
  Technique bare = technique;
  bare.needs.effects = {};
  return bare;
}

struct UnusedEffects : testing::TestWithParam<const Technique*> {};

TEST_P(UnusedEffects, CostNothing) {
  const Technique& technique = *GetParam();
  ASSERT_EQ(technique.needs.effects.size(), all_effects.size());
  const Scene scene = small_scene_of_casters().scene;
  const View view = small_view(33, 19);
  ASSERT_TRUE(plan_frame(scene, view, {}, technique.needs).effects.empty());
  EXPECT_EQ(observe(test_devices(), scene, view, technique, {}),
            observe(test_devices(), scene, view, without_effects(technique), {}));
}

// Features that are no effects of the table, with what the names or defines of their programs contain.
const std::map<std::string, std::string> features{{"shadows", "SHADOWS"},
                                                  {"samples", "SAMPLE_PLACES"},
                                                  {"caps", "cap_lists"},
                                                  {"sampled lists", "sample_l"},
                                                  {"tree", "sample_tree"},
                                                  {"factors of lists", "LIST_FACTORS"},
                                                  {"virtual lights", "VIRTUAL_"},
                                                  {"spots", "SPOTS"},
                                                  {"coats", "CLEARCOAT"},
                                                  {"reflectances", "SPECULAR"},
                                                  {"skin", "SKIN"},
                                                  {"Minnaert", "MINNAERT"}};

TEST_P(UnusedEffects, OtherFeaturesHaveNoText) {
  const std::string programs =
      observe(test_devices(), small_scene().scene, small_view(33, 19), *GetParam(), {}).at("programs");
  for (const auto& [feature, text] : features)
    EXPECT_EQ(programs.find(text), std::string::npos) << feature << " in " << programs;
}

LIGHTGRID_TECHNIQUES_OF_BOTH_TIERS(UnusedEffects);

TEST(UsedEffects, OtherFeaturesHaveTheirText) {
  SmallScene s = small_scene_of_casters();
  for (const char* name : {"clearcoat", "minnaert", "specular", "spot"}) effect(name).add(s);
  s.scene.lights.back().is_virtual = true;
  std::string programs;
  for (const char* order : {"brightest", "sampled", "tree"})
    programs += observe(test_devices(), s.scene, small_view(33, 19), find_technique("visibility"),
                        {"samples=4", "list-cap=4", std::string("list-cap-order=") + order})
                    .at("programs");
  for (const auto& [feature, text] : features)
    EXPECT_NE(programs.find(text), std::string::npos) << feature << " in " << programs;
}

TEST(UsedEffects, ShowInTheSameComparison) {
  SmallScene s = small_scene();
  effect("groups").add(s);
  const Technique& technique = find_technique("forward_plus");
  const View view = small_view(33, 19);
  const Observed with = observe(test_devices(), s.scene, view, technique, {}),
                 without = observe(test_devices(), s.scene, view, without_effects(technique), {});
  for (const char* fact : {"programs", "memory", "first image"})
    EXPECT_NE(with.at(fact), without.at(fact)) << fact;
}

}  // namespace
}  // namespace lightgrid
