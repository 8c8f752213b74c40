// The sums of a light buffer on cases by hand.
#include "support/light_sums.h"

#include <gtest/gtest.h>

namespace lightgrid::lab {
namespace {

ViewLight lamp(const glm::dvec3& position, const glm::dvec3& intensity) {
  ViewLight light;
  light.position = position;
  light.radiant_intensity = intensity;
  return light;
}

// A light at the eye, 2 m in front of the surface, without a range: n.l = n.h = v.h = 1, attenuation 1/4.
TEST(LightSums, OfALightAtTheEyeAreItsIrradiance) {
  const std::vector<ViewLight> lights = {lamp({0, 0, 0}, {8, 4, 2})};
  const LightSums s = light_sums({0, 0, -2}, {0, 0, 1}, lights, 32);
  EXPECT_EQ(s.diffuse, glm::dvec3(2, 1, 0.5));
  EXPECT_EQ(s.specular, 2);
  EXPECT_EQ(s.weight, 2);
  EXPECT_EQ(s.rim, 0);
}

// From 60 degrees beside the eye: n.l = 1/2, the half vector lies at 30 degrees to both, v.h = n.h =
// sqrt(3)/2.
TEST(LightSums, OfALightBesideTheEyeByHand) {
  const std::vector<ViewLight> lights = {lamp(glm::dvec3(std::sqrt(3.0), 0, -1), {1, 1, 1})};
  const LightSums s = light_sums({0, 0, -2}, {0, 0, 1}, lights, 4);
  const double schlick = std::pow(1 - std::sqrt(0.75), 5);
  EXPECT_NEAR(s.weight, 0.5 / 4, 1e-15);
  EXPECT_NEAR(s.diffuse.x, 0.5 / 4 * (1 - schlick), 1e-15);
  EXPECT_NEAR(s.specular, 0.5 / 4 * 0.75 * 0.75, 1e-15);
  EXPECT_NEAR(s.rim, 0.5 / 4 * 0.75 * 0.75 * schlick, 1e-15);
}

TEST(LightSums, AreZeroForLightsBehindTheSurfaceOrAtIt) {
  const std::vector<ViewLight> lights = {lamp({0, 0, -3}, {1, 1, 1}), lamp({0, 0, -2}, {1, 1, 1})};
  const LightSums s = light_sums({0, 0, -2}, {0, 0, 1}, lights, 32);
  EXPECT_EQ(s.diffuse, glm::dvec3(0));
  EXPECT_EQ(s.weight, 0);
}

}  // namespace
}  // namespace lightgrid::lab
