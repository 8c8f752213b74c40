// A camera's turn brings effects into the plan and takes others from it. The small scene lies within 30
// degrees of the view ahead and the square view spans 60: a turn by 90 degrees leaves nothing of it in view.
#include "plan/plan_changes.h"

#include <gmock/gmock.h>

#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "scene/camera_path.h"
#include "support/small_scene.h"

namespace lightgrid {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr TechniqueNeeds reads_grid{.lists = {.light_grid = true}}, reads_no_grid{};

// Ahead, left, behind, right, and the same again: frames 0 and 4 show the scene.
std::vector<PlanChange> along_two_turns(const Scene& scene, const Settings& settings = {},
                                        const TechniqueNeeds& needs = reads_grid) {
  PathPlans plans;
  for (int turn = 0; turn < 2; ++turn) {
    for (const View& view : camera_path(scene, small_view(32, 32), "turn:4"))
      plans.add(plan_frame(scene, view, settings, needs));
  }
  return plans.changes();
}

std::vector<PlanChange> with_effect(const std::string& name, const Settings& settings = {},
                                    const TechniqueNeeds& needs = reads_grid) {
  SmallScene s = small_scene();
  effect(name).add(s);
  return along_two_turns(s.scene, settings, needs);
}

const std::string ball = "material 1 \"steel\" on node 1 \"ball\"",
                  pane = "material 2 \"glass\" on node 2 \"pane\"";

TEST(PlanChanges, AnEffectLeavesWithItsWitnessAndComesBackWithIt) {
  EXPECT_THAT(with_effect("clearcoat"), ElementsAre(PlanChange{1, "clearcoat", false, "left: " + ball},
                                                    PlanChange{4, "clearcoat", true, "came: " + ball},
                                                    PlanChange{5, "clearcoat", false, "left: " + ball}));
}

TEST(PlanChanges, WhatFollowsFromAnEffectChangesWithIt) {
  EXPECT_THAT(with_effect("unlit"), ElementsAre(PlanChange{1, "unlit materials", false, "left: " + ball},
                                                PlanChange{1, "base lighting", false, "left: " + ball},
                                                PlanChange{4, "unlit materials", true, "came: " + ball},
                                                PlanChange{4, "base lighting", true, "came: " + ball},
                                                PlanChange{5, "unlit materials", false, "left: " + ball},
                                                PlanChange{5, "base lighting", false, "left: " + ball}));
  EXPECT_THAT(with_effect("blend"), ElementsAre(PlanChange{1, "blend", false, "left: " + pane},
                                                PlanChange{1, "blended light grid", false, "left: " + pane},
                                                PlanChange{4, "blend", true, "came: " + pane},
                                                PlanChange{4, "blended light grid", true, "came: " + pane},
                                                PlanChange{5, "blend", false, "left: " + pane},
                                                PlanChange{5, "blended light grid", false, "left: " + pane}));
  EXPECT_THAT(with_effect("blend", {}, reads_no_grid),
              ElementsAre(PlanChange{1, "blend", false, "left: " + pane},
                          PlanChange{4, "blend", true, "came: " + pane},
                          PlanChange{5, "blend", false, "left: " + pane}));
}

TEST(PlanChanges, PlainSurfacesAndLightsChangeNothing) {
  EXPECT_THAT(along_two_turns(small_scene().scene), IsEmpty());
  EXPECT_THAT(with_effect("spot"), IsEmpty()) << "a spot out of view keeps its cone";
  EXPECT_THAT(with_effect("directional"), IsEmpty());
}

TEST(PlanChanges, AnEffectThatAnotherSurfaceStillNeedsStays) {
  SmallScene s = small_scene();
  effect("clearcoat").add(s);
  add_instance(s.scene, "ball to the left", s.ball, placed({-3, 0, 0}));
  const std::string left_ball = "material 1 \"steel\" on node 2 \"ball to the left\"";
  EXPECT_THAT(along_two_turns(s.scene), ElementsAre(PlanChange{2, "clearcoat", false, "left: " + left_ball},
                                                    PlanChange{4, "clearcoat", true, "came: " + ball},
                                                    PlanChange{6, "clearcoat", false, "left: " + left_ball}));
}

TEST(PlanChanges, WhatASettingLeavesOutDoesNotChange) {
  EXPECT_THAT(with_effect("clearcoat", {{setting::brdf, Brdf::lambert}}), IsEmpty());
  EXPECT_THAT(with_effect("clearcoat", {{setting::everything_on, true}}), IsEmpty());
}

TEST(PlanChanges, OfTwoPlansNameTheFrame) {
  const std::vector<Decision> with = {{"a", true, "x"}, {"b", false, "none"}, {"c", true, "z"}},
                              without = {{"a", false, "none"}, {"b", true, "y"}, {"c", true, "w"}};
  EXPECT_THAT(plan_changes(with, without, 7),
              ElementsAre(PlanChange{7, "a", false, "left: x"}, PlanChange{7, "b", true, "came: y"}));
  EXPECT_THAT(plan_changes({}, with, 7), IsEmpty());
}

}  // namespace
}  // namespace lightgrid
