// Light profiles: every technique against forward, and both APIs against the oracle in double, in hard cases.
#include <numbers>

#include "support/profile_text.h"
#include "support/small_scene.h"
#include "techniques/against_the_oracle.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

double ripple(double v, double h) {
  const double rad = std::numbers::pi / 180;
  return 75 + 40 * std::cos(3 * h * rad) * std::sin(v * rad) + 30 * std::cos(5 * v * rad);
}

SharedTable rippled(std::vector<double> vertical, std::vector<double> horizontal, int type = 1) {
  return ProfileText{
      .vertical = std::move(vertical), .horizontal = std::move(horizontal), .candela = ripple, .type = type}
      .table();
}

struct ProfileCase {
  std::string name;
  std::function<void(Light&)> set;
};

void give(Light& light, SharedTable table) { light_profile.set(light, std::move(table)); }

// Each changes a point light between the wall and the ball that shines to the wall, direction -z.
std::vector<ProfileCase> profile_cases() {
  const auto full = equal_angles(0, 180, 36);
  return {
      {"OneAngle", [](Light& l) { give(l, ProfileText{.vertical = {0}, .candela = ripple}.table()); }},
      {"NoLight",
       [](Light& l) {
         give(l, ProfileText{.vertical = {0, 90}, .candela = [](double, double) { return 0; }}.table());
       }},
      {"Rotational", [=](Light& l) { give(l, rippled(full, {0})); }},
      {"EndsBrightAtTheHorizon",
       [](Light& l) {
         give(l, rippled(equal_angles(0, 90, 18), {0}));
         l.direction = glm::normalize(glm::vec3(1, 0.3f, -0.2f));
       }},
      {"UpwardsOnly",
       [](Light& l) {
         give(l, rippled(equal_angles(90, 180, 18), {0}));
         l.direction = {0, 0, 1};
       }},
      {"Quadrants", [=](Light& l) { give(l, rippled(full, equal_angles(0, 90, 6))); }},
      {"Mirrored", [=](Light& l) { give(l, rippled(full, equal_angles(0, 180, 12))); }},
      {"From90To270", [=](Light& l) { give(l, rippled(full, equal_angles(90, 270, 12))); }},
      {"SeamOfTheTurn",
       [=](Light& l) {
         give(l,
              ProfileText{.vertical = full,
                          .horizontal = equal_angles(0, 360, 24),
                          .candela = [](double v, double h) { return h == 0 || h == 360 ? 5 : 10 + h + v; }}
                  .table());
         set_up(l, {1, 0.2, 0});
       }},
      {"TypeB", [](Light& l) { give(l, rippled(equal_angles(-90, 90, 36), equal_angles(0, 90, 18), 2)); }},
      {"TypeA", [](Light& l) { give(l, rippled(equal_angles(0, 90, 18), equal_angles(-90, 90, 36), 3)); }},
      {"TypeBSideways",
       [](Light& l) {
         give(l, rippled(equal_angles(-90, 90, 36), equal_angles(-90, 90, 36), 2));
         l.direction = glm::normalize(glm::vec3(1, 0.5f, -0.3f));
       }},
      {"PoleOnTheWall",
       [=](Light& l) {
         give(l, ProfileText{.vertical = full,
                             .horizontal = equal_angles(0, 360, 8),
                             .candela =
                                 [](double v, double h) {
                                   return v == 0 || v == 180 ? 50 : 50 + std::fmod(h, 360) / 9;
                                 }}
                     .table());
       }},
      {"NarrowBeam",
       [](Light& l) {
         give(l, ProfileText{.vertical = {0, 4, 4.5, 90}, .candela = [](double v, double) { return v < 4.2; }}
                     .table());
       }},
      {"IrregularAngles",
       [](Light& l) {
         give(l, rippled({0, 13.37, 61.03, 90, 120, 180}, {0, 10, 77, 90}));
       }},
      {"ShearedNode",
       [=](Light& l) {
         give(l, rippled(full, equal_angles(0, 360, 24)));
         l.direction = glm::normalize(glm::vec3(0.4f, 0.7f, -0.6f));
         set_up(l, {0.3, 0.7, -0.6});
       }},
      {"UpAlongTheDirection",
       [=](Light& l) {
         give(l, rippled(full, equal_angles(0, 360, 24)));
         l.direction = {0, -1, 0};
       }},
      {"InsideTheWall",
       [=](Light& l) {
         give(l, rippled(full, equal_angles(0, 360, 24)));
         l.position.z = -4;
       }},
      {"WithACone",
       [=](Light& l) {
         give(l, rippled(full, equal_angles(0, 360, 24)));
         l.type = LightType::spot;
         l.inner_cone_rad = 0.3f;
         l.outer_cone_rad = 1.2f;
       }},
  };
}

Scene scene_of_profile(const ProfileCase& c) {
  SmallScene s = small_scene(false);
  s.scene.ambient = glm::vec3(0.01f);
  Light& light = add_point(s.scene, "lamp", {-0.2f, 0.3f, -3.1f}, {1, 0.9f, 0.8f}, 3, 5);
  c.set(light);
  return s.scene;
}

struct LightProfileCase : testing::TestWithParam<ProfileCase> {};

TEST_P(LightProfileCase, IsThatOfTheOracle) {
  expect_the_oracles(scene_of_profile(GetParam()), small_view(95, 63));
}

INSTANTIATE_TEST_SUITE_P(Of, LightProfileCase, testing::ValuesIn(profile_cases()),
                         [](const auto& info) { return info.param.name; });

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
