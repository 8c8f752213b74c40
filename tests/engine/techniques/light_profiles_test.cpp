// Light profiles: every technique against forward. Hard cases against the oracle: laboratory/verify/effect_rows.cpp.
#include "support/small_scene.h"
#include "techniques/against_the_oracle.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

struct LightProfilesOf : testing::TestWithParam<const Technique*> {};

TEST_P(LightProfilesOf, AreThoseOfForward) {
  if (GetParam()->approximate) GTEST_SKIP() << "draws another picture";
  SmallScene s = small_scene();
  for (const char* name : {"blend", "spot", "directional", "profiles"}) effect(name).add(s);
  const View view = small_view(47, 31);
  const Image forward = render(s.scene, view, "forward");
  ASSERT_GT(compare_images(render(s.scene, view, "forward", assigned("light-profiles=off")), forward).max_rel,
            0.05);
  expect_close(s.scene, view, {}, forward, GetParam()->name, other_order);
}

INSTANTIATE_TEST_SUITE_P(Techniques, LightProfilesOf, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

TEST(LightProfiles, HaveTheSameBytesInBothKernelShapes) {
  SmallScene s = small_scene();
  effect("profiles").add(s);
  const View view = small_view(61, 47);
  const Image lanes = render(s.scene, view, "visibility", assigned("kernel-shape=lanes"));
  EXPECT_TRUE(identical(render(s.scene, view, "visibility", assigned("kernel-shape=group")), lanes));
  EXPECT_TRUE(identical(render(s.scene, view, "visibility", assigned("portable=on")), lanes));
}

TEST(LightProfiles, FollowTheCameraAndTheLights) {
  SmallScene s = small_scene();
  effect("profiles").add(s);
  for (const char* technique : {"forward_plus", "visibility"}) {
    TechniqueRun run(test_devices(), s.scene, small_view(31, 23), {}, find_technique(technique));
    run.run_frame();
    const View moved = make_view(look_at({0.4, 0.2, 0.5}, {0, 0, -4}), 31, 23);
    run.view().look(moved);
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(s.scene, moved, technique)));
    s.scene.lights[0].direction = glm::normalize(glm::vec3(1, 1, -1));
    run.view().lights_changed();
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(s.scene, moved, technique)));
  }
}

// A scene without profiles is drawn by the same programs, with the same memory.
TEST(LightProfiles, AreNothingWhereNoLightHasOne) {
  const SmallScene s = small_scene();
  const View view = small_view(31, 23);
  for (const char* technique : {"forward_plus", "visibility"}) {
    TechniqueRun with(test_devices(), s.scene, view, {}, find_technique(technique));
    TechniqueRun without(test_devices(), s.scene, view, assigned("light-profiles=off"),
                         find_technique(technique));
    with.run_frame();
    without.run_frame();
    EXPECT_TRUE(with.view().plan.effects.empty());
    EXPECT_TRUE(identical(with.image(), without.image()));
    EXPECT_EQ(with.result().memory_total, without.result().memory_total);
  }
}

}  // namespace
}  // namespace lightgrid
