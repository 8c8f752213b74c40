// Which virtual lights follow from what the views of lights reflect.
#include "scene/virtual_lights.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support/small_scene.h"

namespace lightgrid {
namespace {

using glm::dvec3;

Light lamp(LightType type, float outer_cone_rad = 0.7f) {
  Light light;
  light.type = type;
  light.position = {1, 2, 3};
  light.direction = {0, -1, 0};
  light.outer_cone_rad = outer_cone_rad;
  return light;
}

// Two views of 4 x 4 pixels, 2 m ahead. Every pixel but the first of each reflects, the second view thrice.
std::vector<ReflectedView> two_views() {
  std::vector<ReflectedView> views;
  const std::vector<View> six = views_from(lamp(LightType::point), 4, 0.1);
  for (const int i : {0, 3}) {
    ReflectedView& v = views.emplace_back(ReflectedView{six[size_t(i)], {}});
    for (int pixel = 0; pixel < 16; ++pixel) {
      ReflectedPixel& p = v.pixels.emplace_back();
      if (pixel == 0) continue;
      p.flux = glm::vec3(1, 0.5f, 0.25f) * (i == 0 ? 1.f : 3.f);
      p.area_m2 = 0.5f;
      p.normal = {0, 0, 1};
      p.ahead_m = 2;
    }
  }
  return views;
}

TEST(VirtualLights, AreHemispheresOfWhichCullingKnowsTheCone) {
  Light light;
  make_virtual(light);
  EXPECT_GE(std::cos(double(light.outer_cone_rad)), 0);
  EXPECT_LT(std::cos(double(light.outer_cone_rad)), 1e-6);
  EXPECT_EQ(light.type, LightType::spot);
  EXPECT_TRUE(std::isinf(light.radius_m));
}

TEST(VirtualLights, SeeASpotInOneViewAndAPointLightInSix) {
  EXPECT_EQ(views_from(lamp(LightType::spot), 16, 0.1).size(), 1u);
  EXPECT_EQ(views_from(lamp(LightType::spot, 1.5f), 16, 0.1).size(), 6u);
  std::vector<dvec3> axes;
  for (const View& v : views_from(lamp(LightType::point), 16, 0.1)) {
    EXPECT_EQ(v.eye, dvec3(1, 2, 3));
    axes.push_back(glm::round(-glm::transpose(glm::dmat3(v.view_from_world))[2]));
  }
  EXPECT_THAT(axes, testing::UnorderedElementsAre(dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(0, 1, 0),
                                                  dvec3(0, -1, 0), dvec3(0, 0, 1), dvec3(0, 0, -1)));
}

TEST(VirtualLights, ShareTheFluxEquallyAndStandWhereItIs) {
  const std::vector<ReflectedView> views = two_views();
  const std::vector<Light> lights = virtual_lights_of(views, {.count = 400});
  ASSERT_EQ(lights.size(), 400u);
  dvec3 flux(0);
  int of_second = 0;
  for (const Light& light : lights) {
    EXPECT_TRUE(light.is_virtual);
    flux += dvec3(light.color) * double(light.intensity) * std::numbers::pi;
    const dvec3 offset = light.position - dvec3(1, 2, 3);
    const bool second = offset.y < -1.9;  // it belongs to the view downwards
    of_second += second;
    // 1/64 of a pixel's width, 1 m, towards the light.
    EXPECT_NEAR(second ? -offset.y : offset.x, 2 - 1.0 / 64, 1e-9);
    EXPECT_NEAR(glm::dot(dvec3(light.direction), second ? dvec3(0, 1, 0) : dvec3(-1, 0, 0)), 1, 1e-6);
    // 60 pixels' flux of the first view's, over 400 lights: 0.15 of a pixel, and a 0.05 of one of the
    // second's.
    const double of_pixel = second ? 0.05 : 0.15;
    EXPECT_NEAR(light.nearest_m, std::sqrt(0.5 * of_pixel / std::numbers::pi), 1e-6);
  }
  EXPECT_EQ(of_second, 300) << "in proportion to the flux";
  EXPECT_NEAR(flux.r, 15 + 45, 1e-4);
  EXPECT_NEAR(flux.g, 30, 1e-4);
  EXPECT_NEAR(flux.b, 15, 1e-4);
}

TEST(VirtualLights, CoverPixelsMoreEvenlyThanChanceDoes) {
  const std::vector<Light> lights = virtual_lights_of(two_views(), {.count = 60 * 64});
  std::map<std::array<double, 3>, int> at;
  for (const Light& light : lights) ++at[{light.position.x, light.position.y, light.position.z}];
  ASSERT_EQ(at.size(), 30u);
  for (const auto& [place, count] : at) {
    const double expected = place[1] < 0.1 ? 3 * 64 : 64;
    EXPECT_NEAR(count, expected, 4);  // random ones have a standard deviation of 8 and 14
  }
}

TEST(VirtualLights, AreTheSameEachTimeAndOthersWithAnotherSeed) {
  const std::vector<Light> a = virtual_lights_of(two_views(), {.count = 50});
  EXPECT_EQ(a, virtual_lights_of(two_views(), {.count = 50}));
  EXPECT_NE(a, virtual_lights_of(two_views(), {.count = 50, .seed = 2}));
  for (const Light& light : virtual_lights_of(two_views(), {.count = 50, .nearest_m = 0.5}))
    EXPECT_EQ(light.nearest_m, 0.5f);
}

TEST(VirtualLights, OfDarknessReachNothing) {
  std::vector<ReflectedView> views = two_views();
  for (ReflectedView& v : views) v.pixels.assign(16, {});
  const std::vector<Light> lights = virtual_lights_of(views, {.count = 3});
  ASSERT_EQ(lights.size(), 3u);
  for (const Light& light : lights) EXPECT_TRUE(light.intensity == 0 && light.radius_m == 0);
  EXPECT_TRUE(virtual_lights_of(views, {.count = 0}).empty());
}

TEST(VirtualLights, ReflectTheMostImportantLightsThatHaveAPlace) {
  Scene scene = small_scene(false).scene;
  for (const float intensity : {1.f, 5.f, 3.f, 9.f}) {
    scene.lights.push_back(lamp(LightType::point));
    scene.lights.back().intensity = intensity;
  }
  scene.lights[3].type = LightType::directional;
  make_virtual(scene.lights.emplace_back());
  EXPECT_THAT(reflected_lights(scene, 2), testing::ElementsAre(1, 2));
  EXPECT_THAT(reflected_lights(scene, SIZE_MAX), testing::ElementsAre(0, 1, 2));
}

}  // namespace
}  // namespace lightgrid
