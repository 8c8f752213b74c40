// The bounds of lights: scene/view_lights.h.
#include "scene/view_lights.h"

#include "reference/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lightgrid {
namespace {

TEST(LightBounds, OfAPointLightAreItsBall) {
  const LightBounds b = bounds_of(ViewLight{.position = {1, 2, 3}, .radius_m = 4, .cos_outer = 0.5});
  EXPECT_EQ(b.position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(b.radius_m, 4);
  EXPECT_FALSE(b.has_cone());
  EXPECT_DOUBLE_EQ(b.widened_angle_rad(), std::numbers::pi);
}

TEST(LightBounds, OfASpotHaveItsConeWidenedByTheCosinesRounding) {
  const LightBounds b =
      bounds_of(ViewLight{.type = LightType::spot, .direction = {0, 1, 0}, .cos_outer = 0.5});
  EXPECT_TRUE(b.has_cone());
  EXPECT_EQ(b.direction, glm::dvec3(0, 1, 0));
  EXPECT_DOUBLE_EQ(b.widened_angle_rad(), std::acos(0.5 - 1e-6));
  EXPECT_DOUBLE_EQ(bounds_of(ViewLight{.type = LightType::spot, .cos_outer = -1}).widened_angle_rad(),
                   std::numbers::pi);
}

// The culler gets the first, what draws gets the second.
TEST(LightBounds, AreTheSameOfTheWorldAndOfAView) {
  Scene scene;
  scene.lights.push_back({.type = LightType::spot,
                          .position = {1, 2, 3},
                          .direction = {0, 3, 4},
                          .radius_m = 5,
                          .inner_cone_rad = 0.5f,
                          .outer_cone_rad = 2});
  const View view;  // at the origin, along -z
  const LightBounds world = bounds_of(scene.lights[0], 5), seen = bounds_of(lights_in_view(scene, view)[0]);
  EXPECT_EQ(world.position, seen.position);
  EXPECT_EQ(world.radius_m, seen.radius_m);
  EXPECT_EQ(world.direction, seen.direction);
  EXPECT_EQ(world.cos_outer, seen.cos_outer);
}

Light spot_of(float inner, float outer) {
  return {.type = LightType::spot, .radius_m = 5, .inner_cone_rad = inner, .outer_cone_rad = outer};
}
ViewLight seen(const Light& light) {
  Scene scene;
  scene.lights = {light};
  return lights_in_view(scene, View())[0];
}

TEST(ConeCosine, OfTheFloatsNextTo90And180DegreesIsExact) {
  constexpr float pi = std::numbers::pi_v<float>;
  EXPECT_EQ(cone_cosine(pi / 2), 0);
  EXPECT_EQ(cone_cosine(pi), -1);
  EXPECT_EQ(cone_cosine(std::nextafter(pi / 2, 0.0f)), std::cos(double(std::nextafter(pi / 2, 0.0f))));
  EXPECT_EQ(seen(spot_of(0, pi / 2)).cos_outer, 0);
  EXPECT_EQ(bounds_of(spot_of(0, pi / 2), 5).cos_outer, 0);
}

// Full light inside and none outside, however narrow the cone is.
TEST(Attenuation, OfEqualAnglesIsAStep) {
  for (const float angle : {1e-3f, 0.02f, 0.6f, 1.5f, std::numbers::pi_v<float> / 2, 3.0f}) {
    const ViewLight light = seen(spot_of(angle, angle));
    const auto at = [&](double off) {
      return attenuation(light, {std::sin(angle + off), 0, -std::cos(angle + off)}, false);
    };
    EXPECT_EQ(at(-1e-6), 1) << angle;
    EXPECT_NEAR(at(-0.5 * angle), 1, 1e-15) << angle;
    EXPECT_EQ(at(1e-6), 0) << angle;
  }
}

TEST(Attenuation, OfAConeOfNoWidthIsNoneAndOf180DegreesIsAPoints) {
  EXPECT_EQ(attenuation(seen(spot_of(0, 0)), {0, 0, -1}, true), 0);
  const ViewLight all = seen(spot_of(4, 4));
  EXPECT_GT(attenuation(all, {0, 0, 1}, true), 0);
  EXPECT_FALSE(has_cone(all));
}

// As before: KHR_lights_punctual's quotient.
TEST(Attenuation, OfAlmostEqualAnglesKeepsTheExtensionsFormula) {
  const float outer = 0.02f;
  const double cosine = std::cos(double(outer));
  const double t = (1 - cosine) / 0.001;
  EXPECT_NEAR(attenuation(seen(spot_of(std::nextafter(outer, 0.0f), outer)), {0, 0, -1}, false), t * t,
              1e-12);
}

}  // namespace
}  // namespace lightgrid
