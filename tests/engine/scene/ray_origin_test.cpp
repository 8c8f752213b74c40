#include "scene/ray_origin.h"

#include <gtest/gtest.h>

namespace lightgrid {
namespace {

using glm::dvec3;

Light lamp_at(const dvec3& place) {
  Light light;
  light.position = place;
  return light;
}

Scene with_lamps(std::vector<dvec3> places) {
  Scene scene;
  for (const dvec3& place : places) scene.lights.push_back(lamp_at(place));
  return scene;
}

TEST(RayOrigin, IsTheMedianOfEachCoordinateOfTheLightsRoundedTo64Metres) {
  EXPECT_EQ(ray_origin(with_lamps({{1000, 5, -300}, {900, 40, -250}, {1e9, -1e9, 0}})), dvec3(1024, 0, -256));
  EXPECT_EQ(ray_origin(with_lamps({{31, -31, 0}})), dvec3(0));
}

TEST(RayOrigin, AMinorityCannotMoveItHoweverFarAway) {
  const std::vector<dvec3> near{{3, 1, 2}, {-4, 2, 7}, {9, 3, -8}};
  for (const double far_m : {1e4, 1e7, 1e12, 1e30, HUGE_VAL, std::nan("")}) {
    std::vector<dvec3> lamps = near;
    lamps.insert(lamps.begin(), {{far_m, -far_m, far_m}, {far_m, far_m, far_m}});
    EXPECT_EQ(ray_origin(with_lamps(lamps)), dvec3(0)) << far_m;
  }
}

TEST(RayOrigin, CamerasCountAsLightsDoAndSunsDoNot) {
  Scene scene = with_lamps({{0, 0, 0}, {1e6, 0, 0}});
  scene.cameras.resize(3);
  for (Camera& camera : scene.cameras) camera.world_from_view[3] = {640, 0, 0, 1};
  EXPECT_EQ(ray_origin(scene), dvec3(640, 0, 0));
  scene.cameras.resize(1);
  scene.lights[0].type = scene.lights[1].type = LightType::directional;
  EXPECT_EQ(ray_origin(scene), dvec3(640, 0, 0));
}

TEST(RayOrigin, WithoutLightsAndCamerasTheInstancesCount) {
  Scene scene;
  scene.meshes.resize(2);  // the second has no vertex, and is nowhere
  scene.meshes[0].positions = {{1, 1, 1}};
  for (const double x : {100.0, 120.0, 1e7, 0.0}) {
    scene.instances.push_back({.mesh = x == 0 ? 1 : 0});
    scene.instances.back().world_from_object[3] = {x, 0, 0, 1};
  }
  EXPECT_EQ(ray_origin(scene), dvec3(128, 0, 0));
  EXPECT_EQ(ray_origin(Scene()), dvec3(0));
}

// Every 201st of 200,000 lights counts: the median is within 201 m, and rounding adds 32.
TEST(RayOrigin, SamplesManyLightsEvenly) {
  std::vector<dvec3> lamps;
  for (int i = 0; i < 200'000; ++i) lamps.push_back({i, 0, 0});
  EXPECT_NEAR(ray_origin(with_lamps(lamps)).x, 100'000, 233);
}

}  // namespace
}  // namespace lightgrid
