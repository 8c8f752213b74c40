// Cookies in hard cases: both APIs against the oracle in double. every_effect_test.cpp has all techniques.
#include "support/cookie_image.h"

#include "support/small_scene.h"
#include "techniques/against_the_oracle.h"
#include "techniques/lidr_scenes.h"

namespace lightgrid {
namespace {

struct CookieCase {
  std::string name;
  std::function<void(Light&)> set;
  bool orthographic = false;
};

void point(Light& l, SharedTable table) { light_cookie.set(l, std::move(table)); }

void project(Light& l, SharedTable table, float outer_rad = 0.9f) {
  point(l, std::move(table));
  l.type = LightType::spot;
  l.inner_cone_rad = 0.5f * outer_rad;
  l.outer_cone_rad = outer_rad;
}

SharedTable checker(int side) {
  return cookie_image(side, side, [](int x, int y) {
    return (x + y) % 2 ? glm::u8vec3(255, 240, 200) : glm::u8vec3(20, 0, 40);
  });
}

// Each changes a point light between the wall and the ball that shines to the wall, direction -z.
std::vector<CookieCase> cookie_cases() {
  return {
      {"Projected", [](Light& l) { project(l, speckled_cookie(16, 16)); }},
      {"ProjectedObliquely",
       [](Light& l) {
         project(l, speckled_cookie(16, 12));
         l.direction = glm::normalize(glm::vec3(0.7f, -0.4f, -0.6f));
         set_up(l, {0.2, 1, 0.4});
       }},
      {"HardEdgeOfTheCone",
       [](Light& l) {
         project(l, speckled_cookie(8, 8));
         l.inner_cone_rad = l.outer_cone_rad;
       }},
      {"WidestProjector", [](Light& l) { project(l, speckled_cookie(32, 32), 1.49f); }},
      {"WiderThanAProjector", [](Light& l) { project(l, speckled_cookie(32, 32), 2.4f); }},
      {"Narrow", [](Light& l) { project(l, speckled_cookie(8, 8), 0.05f); }},
      {"Around", [](Light& l) { point(l, speckled_cookie(32, 16)); }},
      {"SeamAndPoles",
       [](Light& l) {
         point(l, speckled_cookie(32, 16));
         l.direction = {0, 0, 1};
         set_up(l, {0, 1, -1.5});
       }},
      {"PoleOnTheWall",
       [](Light& l) {
         point(l, speckled_cookie(64, 32));
         l.direction = {0, 1, 0};
         set_up(l, {0, 0, -1});
       }},
      {"OneTexel", [](Light& l) { project(l, speckled_cookie(1, 1)); }},
      {"OddSizes", [](Light& l) { point(l, speckled_cookie(37, 11)); }},
      {"MinifiedChecker", [](Light& l) { project(l, checker(256)); }},
      {"MinifiedAround", [](Light& l) { point(l, checker(512)); }},
      {"Orthographic", [](Light& l) { project(l, checker(128)); }, true},
      {"Black", [](Light& l) { project(l, cookie_image(4, 4, [](int, int) { return glm::u8vec3(0); })); }},
      {"InsideTheWall",
       [](Light& l) {
         point(l, speckled_cookie(16, 16));
         l.position.z = -4;
       }},
      {"WithAProfile",
       [](Light& l) {
         project(l, speckled_cookie(16, 16));
         light_profile.set(
             l, ProfileText{.vertical = {0, 20, 90}, .candela = [](double v, double) { return 100 - v; }}
                    .table());
       }},
  };
}

struct LightCookieCase : testing::TestWithParam<CookieCase> {};

TEST_P(LightCookieCase, IsThatOfTheOracle) {
  SmallScene s = small_scene(false);
  s.scene.ambient = glm::vec3(0.01f);
  GetParam().set(add_point(s.scene, "lamp", {-0.2f, 0.3f, -3.1f}, {1, 0.9f, 0.8f}, 3, 5));
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  if (GetParam().orthographic) {
    camera.orthographic = true;
    camera.half_width_m = 1.8;
    camera.half_height_m = 1.2;
    camera.far_m = 20;
  }
  expect_the_oracles(s.scene, make_view(camera, 95, 63));
}

INSTANTIATE_TEST_SUITE_P(Of, LightCookieCase, testing::ValuesIn(cookie_cases()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace lightgrid
