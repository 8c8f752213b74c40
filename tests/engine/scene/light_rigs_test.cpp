#include "scene/light_rigs.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "base/error.h"
#include "scene/random.h"
#include "support/error_of.h"

namespace lightgrid {
namespace {

// One floor of 8 x 8 m at y = 0, facing up.
Scene floor_scene() {
  Scene scene;
  scene.name = "floor";
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{-4, 0, 4}, {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}};
  mesh.normals.assign(4, {0, 1, 0});
  mesh.indices = {0, 1, 2, 0, 2, 3};
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  scene.instances.push_back({"floor", 0, glm::dmat4(1)});
  return scene;
}

bool equal(const Light& a, const Light& b) {
  return a.type == b.type && a.position == b.position && a.direction == b.direction && a.color == b.color &&
         a.intensity == b.intensity && a.radius_m == b.radius_m && a.inner_cone_rad == b.inner_cone_rad &&
         a.outer_cone_rad == b.outer_cone_rad && a.name == b.name;
}

TEST(Random, MatchesThePublishedSequence) {
  // SplitMix64 from seed 1234567, as in the Rosetta Code task of that name.
  Random random(1234567);
  EXPECT_EQ(random.next(), 6457827717110365317u);
  EXPECT_EQ(random.next(), 3203168211198807973u);
  EXPECT_EQ(random.next(), 9817491932198370423u);
}

TEST(ScatterLights, TheFirstLightIsTheSameEverywhere) {
  // From the same steps written in another language.
  const Light light = scatter_lights(floor_scene(), {8, 1, 2, 1}).at(0);
  EXPECT_EQ(light.position, glm::dvec3(0x1.8fb61441c6f51p+0, 0x1.278ae8dd40280p-1, -0x1.94ba22bf5ea16p+1));
  EXPECT_EQ(light.radius_m, 0x1.58ecdcp+0f);
  EXPECT_EQ(light.intensity, 0x1.58ecdcp+0f * 0x1.58ecdcp+0f / 8);
  EXPECT_EQ(light.color, glm::vec3(0x1.cfc198p-1f, 1, 0.25f));
}

TEST(ScatterLights, FewerLightsAreTheFirstOfMore) {
  const auto few = scatter_lights(floor_scene(), {17, 0.5f, 3, 42});
  const auto many = scatter_lights(floor_scene(), {1000, 0.5f, 3, 42});
  ASSERT_EQ(few.size(), 17);
  ASSERT_EQ(many.size(), 1000);
  for (size_t i = 0; i < few.size(); ++i) EXPECT_TRUE(equal(few[i], many[i])) << i;
}

TEST(ScatterLights, OverTheSurfaceOnItsFrontWithinHalfARadius) {
  for (const Light& light : scatter_lights(floor_scene(), {4000, 1, 3, 5})) {
    EXPECT_LE(std::abs(light.position.x), 4);
    EXPECT_LE(std::abs(light.position.z), 4);
    EXPECT_GE(light.position.y, 0);
    EXPECT_LE(light.position.y, light.radius_m / 2);
    EXPECT_GE(light.radius_m, 1);
    EXPECT_LE(light.radius_m, 3);
  }
}

TEST(ScatterLights, AMirroredFloorIsLitFromItsOtherSide) {
  Scene scene = floor_scene();
  scene.instances[0].world_from_object[1] *= -1;  // y -> -y: the front now faces down
  for (const Light& light : scatter_lights(scene, {100, 1, 3, 5})) EXPECT_LE(light.position.y, 0);
}

TEST(ScatterLights, AreaDecidesHowManyATriangleGets) {
  Scene scene = floor_scene();
  glm::dmat4 third(1);
  third[0].x = 1.0 / 3;
  third[3].y = 100;
  scene.instances.push_back({"a third as large", 0, third});
  int above = 0;
  const auto lights = scatter_lights(scene, {40'000, 1, 1, 9});
  for (const Light& light : lights) above += light.position.y > 50;
  // A quarter of the area: 10,000 expected, standard deviation 87.
  EXPECT_NEAR(above, 10'000, 5 * 87);
}

TEST(ScatterLights, OneInEightIsASpotAimedAtTheSurface) {
  int spots = 0;
  for (const Light& light : scatter_lights(floor_scene(), {800, 1, 2, 3})) {
    if (light.type != LightType::spot) continue;
    ++spots;
    EXPECT_LT(light.direction.y, 0);
    EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
    EXPECT_LT(light.inner_cone_rad, light.outer_cone_rad);
    EXPECT_LT(light.outer_cone_rad, 1.58f);
  }
  EXPECT_EQ(spots, 100);
}

TEST(ScatterLights, ChosenRadiiReachAPointFromAboutEightLights) {
  // 64 m^2, 2000 lights: radius sqrt(8 * 64 / (pi * 2000)) = 0.28546 m, times 0.6 to 1.4.
  const auto lights = scatter_lights(floor_scene(), {2000});
  for (const Light& light : lights) {
    EXPECT_GE(light.radius_m, 0.1712f);
    EXPECT_LE(light.radius_m, 0.3997f);
  }
}

TEST(ScatterLights, RefusesWhatCannotBeScattered) {
  const auto refused = [](const Scene& scene, const ScatterSettings& settings) -> std::string {
    return error_of([&] { scatter_lights(scene, settings); });
  };
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  EXPECT_EQ(refused(floor_scene(), {-1}), "lights -1: not in 0..10000000");
  EXPECT_EQ(refused(floor_scene(), {1 << 30}), "lights 1073741824: not in 0..10000000");
  EXPECT_EQ(refused(floor_scene(), {1, 2, 1}), "light-radius 2,1: not 0 < MIN <= MAX");
  EXPECT_EQ(refused(floor_scene(), {1, 0, 1}), "light-radius 0,1: not 0 < MIN <= MAX");
  EXPECT_EQ(refused(floor_scene(), {1, nan, nan}), "light-radius nan,nan: not 0 < MIN <= MAX");
  EXPECT_EQ(refused(floor_scene(), {1, 1, inf}), "light-radius 1,inf: not 0 < MIN <= MAX");
  EXPECT_EQ(refused(floor_scene(), {1, 1, 1e20f}),
            "light-radius 1e+20: the intensity of a light that wide passes the largest float");
  EXPECT_EQ(refused(Scene(), {1}), "lights 1: scene \"\" has no surface to scatter lights over");
  EXPECT_TRUE(scatter_lights(Scene(), {0}).empty());
}

glm::vec3 in_view(const View& view, const Light& light) {
  return glm::vec3(glm::dmat3(view.view_from_world) * glm::dvec3(light.direction));
}

TEST(DefaultLights, StandBesideTheViewerWhereverItLooks) {
  for (const glm::dvec3& eye : {glm::dvec3(0, 0, 5), glm::dvec3(-3, 9, 2), glm::dvec3(0, -4, 0)}) {
    const View view = make_view(look_at(eye, glm::dvec3(0)), 4, 3);
    const DefaultLights rig = default_lights(view);
    ASSERT_EQ(rig.lights.size(), 2u);
    for (const Light& light : rig.lights) {
      EXPECT_EQ(light.type, LightType::directional);
      EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
      EXPECT_LT(in_view(view, light).z, 0) << "shines away from the viewer";
    }
    const glm::vec3 key = in_view(view, rig.lights[0]);
    EXPECT_GT(key.x, 0.4f) << "comes from the left";
    EXPECT_LT(key.y, -0.4f) << "comes from above";
  }
}

TEST(DefaultLights, LeaveWhitePaintThatFacesTheViewerAtEightTenths) {
  const View view = make_view(look_at({1, 2, 3}, {0, 0, 0}), 4, 3);
  const DefaultLights rig = default_lights(view);
  float radiance = rig.ambient.g;
  for (const Light& light : rig.lights) radiance += light.intensity * -in_view(view, light).z / 3.14159265f;
  EXPECT_NEAR(radiance, 0.8f, 0.01f);
}

TEST(ScatterLights, OfAnotherNumberCanKeepTheRangesOfOne) {
  const auto few = scatter_lights(floor_scene(), {.count = 300, .seed = 7});
  const auto many = scatter_lights(floor_scene(), {.count = 1000, .seed = 7, .ranges_of = 300});
  for (size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(many[i].radius_m, few[i].radius_m);
    EXPECT_EQ(many[i].position, few[i].position);
  }
  const auto shrunk = scatter_lights(floor_scene(), {.count = 1000, .seed = 7});
  EXPECT_LT(shrunk[0].radius_m, 0.6f * few[0].radius_m) << "as many lights reach a point";
}

}  // namespace
}  // namespace lightgrid
