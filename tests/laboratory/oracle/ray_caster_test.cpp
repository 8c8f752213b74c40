// The tests' ray caster on cases worked out by hand.
#include "oracle/ray_caster.h"

#include <gtest/gtest.h>

namespace lightgrid::lab::ray_caster {
namespace {

using std::numbers::pi;

void expect_near(const dvec3& got, const dvec3& want, double tolerance = 1e-15) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance) << "channel " << i;
}

TEST(RayCaster, HalfMetalFromStraightAboveIsTheMeanOfTwoMaterials) {
  // N = V = L = H, alpha 1: D = 1 / pi, G = 1, over 4: 1 / (4 pi). Dielectric: 0.96 base / pi + 0.04 / (4
  // pi); metal: base / (4 pi). For base 1, 0.5, 0: pi times their mean is (0.97 + 0.25) / 2, (0.49 + 0.125) /
  // 2, (0.01 + 0) / 2.
  const Material half{.base_color = {1, 0.5, 0, 1}, .metallic = 0.5, .roughness = 1};
  const dvec3 z(0, 0, 1);
  expect_near(material_brdf(half, z, z, z), dvec3(0.61, 0.3075, 0.005) / pi);
}

TEST(RayCaster, SmoothMetalLitAtSixtyDegrees) {
  // V = N, H at 30 degrees, roughness 0.5: alpha^2 = 1/16. N.H^2 = 3/4: D = (1/16) / (pi (1 - 45/64)^2) = 256
  // / (361 pi). tan^2 60 = 3: Lambda = (sqrt(1 + 3/16) - 1) / 2 = (sqrt(19) / 4 - 1) / 2, G = 1 / (1 +
  // Lambda). White: F = 1. Over 4 * 0.5.
  const Material white{.base_color = {1, 1, 1, 1}, .metallic = 1, .roughness = 0.5};
  const dvec3 to_light(std::sqrt(0.75), 0, 0.5), z(0, 0, 1);
  const double shadowing = 1 / (1 + (std::sqrt(19.0) / 4 - 1) / 2);
  expect_near(material_brdf(white, z, to_light, z), dvec3(256 / (361 * pi) * shadowing / 2), 1e-14);
}

TEST(RayCaster, LightsByHand) {
  // 2 m below a light of range 4: (1 - 1/16) / 4 of 2 cd.
  Light light{.position = {0, 2, 0}, .color = {1, 0.5, 0}, .intensity = 2, .radius_m = 4};
  expect_near(illumination(light, {0, 0, 0}).illuminance, dvec3(2, 1, 0) * (15.0 / 64));
  expect_near(illumination(light, {0, 0, 0}).to_light, {0, 1, 0});
  EXPECT_EQ(illumination(light, {0, -2, 0}).illuminance, dvec3(0));
  // A millimetre away, no floor: 1e6 times the intensity, but for the window's 4e-15.
  EXPECT_NEAR(illumination(light, {0, 1.999, 0}).illuminance.r, 2e6, 1e-3);
  // A spot down to its outer angle of 60 degrees, from 0: cos 45 = sqrt(1/2); (sqrt(1/2) - 1/2) / (1/2) =
  // sqrt 2 - 1.
  light = {.type = LightType::spot,
           .position = {0, 1, 0},
           .direction = {0, -1, 0},
           .inner_cone_rad = 0,
           .outer_cone_rad = float(pi / 3)};
  const double t = std::sqrt(2.0) - 1;
  EXPECT_NEAR(illumination(light, {1, 0, 0}).illuminance.r, t * t / 2, 1e-7);  // the angle is a float
  EXPECT_EQ(illumination(light, {3, 0, 0}).illuminance, dvec3(0));
  light = {.type = LightType::directional, .direction = {0, -1, 0}, .intensity = 3};
  expect_near(illumination(light, {1e9, 0, 0}).illuminance, dvec3(3));
}

TEST(RayCaster, RaysMeetPlanesAndTrianglesWhereTheyShould) {
  Camera camera;  // at the origin, along -z
  camera.fov_y_rad = pi / 2;
  // The pixel at the upper right of 2 x 2: slopes of 1/2.
  const Ray ray = ray_through(camera, 2, 2, 1, 1);
  expect_near(ray.direction, dvec3(0.5, 0.5, -1) / std::sqrt(1.5));
  const auto plane = hit_of(Plane{{7, 7, -2}, {0, 0, 1}, 3}, ray);
  ASSERT_TRUE(plane);
  EXPECT_NEAR(plane->distance, 2 * std::sqrt(1.5), 1e-15);
  EXPECT_EQ(plane->material, 3);
  EXPECT_FALSE(hit_of(Plane{{0, 0, 2}, {0, 0, 1}, 0}, ray)) << "behind the eye";

  // It meets z = -2 at (1, 1): half of the second corner, a quarter of the third.
  Triangle triangle{{{0, 0, -2}, {1.5, 1, -2}, {1, 2, -2}}, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}};
  const auto hit = hit_of(triangle, ray, 5);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance, 2 * std::sqrt(1.5), 1e-15);
  expect_near(hit->normal, glm::normalize(dvec3(0.5, 0.25, 0.25)));
  std::swap(triangle.corners[1], triangle.corners[2]);
  EXPECT_FALSE(hit_of(triangle, ray, 5)) << "from behind";
  std::swap(triangle.corners[1], triangle.corners[2]);
  triangle.corners[1] = {0.5, 1, -2};
  triangle.corners[2] = {0, 2, -2};
  EXPECT_FALSE(hit_of(triangle, ray, 5)) << "beside it";
}

}  // namespace
}  // namespace lightgrid::lab::ray_caster
