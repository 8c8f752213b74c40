#include "scene/shadow_casters.h"

#include <gmock/gmock.h>

#include <numbers>

#include "scenes/compose.h"
#include "scenes/shapes.h"

namespace lightgrid {
namespace {

constexpr double pi = std::numbers::pi;

Light light_of(LightType type, float intensity, float radius_m) {
  Light light;
  light.type = type;
  light.intensity = intensity;
  light.radius_m = radius_m;
  light.color = {0.5f, 1, 0.25f};
  return light;
}

// A quad of 6 x 8 m: its diameter is 10 m.
Scene plain_scene() {
  Scene scene;
  add_material(scene, "plaster", {0.5f, 0.5f, 0.5f}, 0, 1);
  Mesh mesh;
  shapes::add_quad(mesh, {-3, 0, 4}, {6, 0, 0}, {0, 0, -8}, 1, 1);
  add_instance(scene, "floor", add_mesh(scene, shapes::finished(std::move(mesh), "floor", 0)));
  return scene;
}

std::vector<bool> casting(Scene scene, size_t count) {
  choose_shadow_casters(scene, count);
  std::vector<bool> casts;
  for (const Light& light : scene.lights) casts.push_back(light.casts_shadow);
  return casts;
}

TEST(ShadowCasters, ImportanceIsTheIrradianceOverTheSpaceThatALightReaches) {
  const Light point = light_of(LightType::point, 3, 2);
  EXPECT_NEAR(light_importance(point, 10), 4 * pi * 3 * 2, 1e-9);
  EXPECT_NEAR(light_importance(light_of(LightType::point, 3, INFINITY), 10), 4 * pi * 3 * 10, 1e-9);
  Light spot = light_of(LightType::spot, 3, 2);
  spot.outer_cone_rad = float(pi / 3);  // a quarter of the sphere
  EXPECT_NEAR(light_importance(spot, 10), pi * 3 * 2, 1e-5);
  EXPECT_NEAR(light_importance(light_of(LightType::directional, 3, 2), 10), 3 * pi / 6 * 1000, 1e-9);
}

TEST(ShadowCasters, TheMostImportantCastAndOfEqualOnesTheFirst) {
  Scene scene = plain_scene();
  scene.lights = {light_of(LightType::point, 1, 1), light_of(LightType::point, 1, 2),
                  light_of(LightType::point, 1, 2), light_of(LightType::directional, 1, 0),
                  light_of(LightType::point, 4, 1)};
  scene.lights[0].casts_shadow = true;  // the choice replaces what the scene says
  EXPECT_EQ(casting(scene, 0), std::vector<bool>({false, false, false, false, false}));
  EXPECT_EQ(casting(scene, 1), std::vector<bool>({false, false, false, true, false}));
  EXPECT_EQ(casting(scene, 2), std::vector<bool>({false, false, false, true, true}));
  EXPECT_EQ(casting(scene, 3), std::vector<bool>({false, true, false, true, true}));
  EXPECT_EQ(casting(scene, 9), std::vector<bool>({true, true, true, true, true}));
}

// Endless lights rank by their intensity.
TEST(ShadowCasters, NoRangeCountsAsTheScenesDiameter) {
  Scene scene = plain_scene();
  scene.lights = {light_of(LightType::point, 1, INFINITY), light_of(LightType::point, 1, 11),
                  light_of(LightType::point, 2, INFINITY), light_of(LightType::point, 1, 9)};
  EXPECT_EQ(casting(scene, 1), std::vector<bool>({false, false, true, false}));
  EXPECT_EQ(casting(scene, 3), std::vector<bool>({true, true, true, false}));
}

}  // namespace
}  // namespace lightgrid
