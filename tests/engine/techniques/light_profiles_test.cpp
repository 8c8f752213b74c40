// Light profiles in hard cases: both APIs against the oracle in double. every_effect_test.cpp has all techniques.
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

}  // namespace
}  // namespace lightgrid
