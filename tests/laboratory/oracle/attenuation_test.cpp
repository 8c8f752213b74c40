#include "oracle/attenuation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oracle/infinity.h"
#include "support/one_spot.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

TEST(Attenuation, WindowAtHalfTheRadiusIsFifteenSixteenths) {
  // 1 - (1/2)^4 = 15/16, over a distance of 1.
  const ViewLight light{.radius_m = 2};
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 1, 0}, true), 15.0 / 16);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 1, 0}, false), 1);
}

TEST(Attenuation, FallsWithTheSquareWhereTheRadiusIsInfinite) {
  EXPECT_DOUBLE_EQ(attenuation({.radius_m = infinity}, {0, 0, -4}, true), 1.0 / 16);
}

TEST(Attenuation, EndsAtTheRadiusOnlyWithItsWindow) {
  const ViewLight light{.radius_m = 2};
  EXPECT_EQ(attenuation(light, {2, 0, 0}, true), 0);
  EXPECT_EQ(attenuation(light, {3, 0, 0}, true), 0);
  EXPECT_DOUBLE_EQ(attenuation(light, {2, 0, 0}, false), 0.25);
}

TEST(Attenuation, GrowsWithTheSquareDownToTheLightAndStaysFinite) {
  EXPECT_DOUBLE_EQ(attenuation({.radius_m = infinity}, {0, 0.1, 0}, true), 100);
  EXPECT_DOUBLE_EQ(attenuation({.radius_m = infinity}, {0, 0.001, 0}, true), 1e6);
  EXPECT_DOUBLE_EQ(attenuation({.radius_m = infinity}, {0, 1e-30, 0}, true), 1e60);
  EXPECT_TRUE(std::isfinite(attenuation({.radius_m = infinity}, {0, 0, 0}, true)));
}

TEST(Attenuation, RadiusZeroIsDarkEvenAtTheLight) {
  EXPECT_EQ(attenuation({.radius_m = 0}, {0, 0, 0}, true), 0);
}

TEST(Attenuation, SpotFallsWithTheSquareBetweenItsCones) {
  // Cosine 0.6 (3, 4, 5) halfway between 0.4 and 0.8: t = 1/2. Distance 5, no window: 1/4 * 1/25.
  const ViewLight light{LightType::spot, {}, {0, 0, -1}, dvec3(1), infinity, 0.8, 0.4};
  EXPECT_NEAR(attenuation(light, {4, 0, -3}, true), 0.01, 1e-17);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 0, -5}, true), 0.04);
  EXPECT_EQ(attenuation(light, {0, 0, 5}, true), 0);
}

TEST(Attenuation, VirtualLightFallsWithTheCosineAndNotBelowItsNearestDistance) {
  // Cosine 0.6 from the axis at distance 5: 3/5 * 1/25. At half the nearest distance as at the whole: 1/4.
  ViewLight light{LightType::spot, {}, {0, 0, -1}, dvec3(1), infinity, 1, 0};
  light.max_falloff = 0.25;
  EXPECT_NEAR(attenuation(light, {4, 0, -3}, true), 0.6 / 25, 1e-17);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 0, -1}, true), 0.25);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 0, -2}, true), 0.25);
  EXPECT_EQ(attenuation(light, {0, 0, 5}, true), 0);
}

TEST(Attenuation, DirectionalIsOneEverywhere) {
  EXPECT_EQ(attenuation({.type = LightType::directional}, {1e9, -4, 0}, true), 1);
}

TEST(Attenuation, FadesByTheWindowOfTheLight) {
  ViewLight light{.radius_m = 2};
  light.window = RangeWindow::smooth;
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 1, 0}, true), 15.0 / 16 * 15 / 16);
  light.window = RangeWindow::none;
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 1.5, 0}, true), 1 / 2.25);
  EXPECT_EQ(attenuation(light, {0, 2, 0}, true), 0);
}

// Reached with p = min(f / alpha, 1), each contribution counts 1 / p times: here 1 / d^2 = 1 / 16 and alpha /
// I = 1 / 4.
TEST(Attenuation, CountsARandomRangeByTheInverseOfItsProbability) {
  ViewLight light{.radius_m = 5};
  light.window = RangeWindow::none;
  light.min_falloff = 0.25;
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 4, 0}, true), 0.25);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 1, 0}, true), 1);  // p = 1
  EXPECT_EQ(attenuation(light, {0, 5, 0}, true), 0);
  EXPECT_DOUBLE_EQ(attenuation(light, {0, 4, 0}, false), 1.0 / 16);
}

// Full light inside and none outside, however narrow the cone is.
TEST(Attenuation, OfEqualAnglesIsAStep) {
  for (const float angle : {1e-3f, 0.02f, 0.6f, 1.5f, std::numbers::pi_v<float> / 2, 3.0f}) {
    const ViewLight light = seen(spot_of(angle, angle));
    const auto at = [&](double off) {
      return attenuation(light, {std::sin(angle + off), 0, -std::cos(angle + off)}, false);
    };
    EXPECT_DOUBLE_EQ(at(-1e-6), 1) << angle;
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
}  // namespace lightgrid::lab
