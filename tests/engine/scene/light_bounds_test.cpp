// The bounds of lights: scene/view_lights.h.
#include "scene/view_lights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "support/one_spot.h"

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

TEST(ConeCosine, OfTheFloatsNextTo90And180DegreesIsExact) {
  constexpr float pi = std::numbers::pi_v<float>;
  EXPECT_EQ(cone_cosine(pi / 2), 0);
  EXPECT_EQ(cone_cosine(pi), -1);
  EXPECT_EQ(cone_cosine(std::nextafter(pi / 2, 0.0f)), std::cos(double(std::nextafter(pi / 2, 0.0f))));
  EXPECT_EQ(seen(spot_of(0, pi / 2)).cos_outer, 0);
  EXPECT_EQ(bounds_of(spot_of(0, pi / 2), 5).cos_outer, 0);
}

}  // namespace
}  // namespace lightgrid
