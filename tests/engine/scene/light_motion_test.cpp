// Lights that move by themselves.
#include "scene/light_motion.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "scenes/builtin.h"

namespace lightgrid {
namespace {

// Point lights of radius 4 m and 100 m in turn, the third a spot, the last directional.
Scene twenty_lights() {
  Scene scene;
  for (int i = 0; i < 20; ++i) {
    scene.lights.push_back({.position = {i, 2 * i, -i}, .radius_m = i % 2 ? 100.0f : 4.0f});
  }
  scene.lights[2].type = LightType::spot;
  scene.lights[19].type = LightType::directional;
  return scene;
}

std::vector<glm::dvec3> positions_of(const Scene& scene) {
  std::vector<glm::dvec3> out;
  for (const Light& light : scene.lights) out.push_back(light.position);
  return out;
}

TEST(LightMotions, at_time_0_lights_have_the_scenes_own_positions_bit_for_bit) {
  for (const char* name : {"hall", "terrain"}) {
    Scene scene = find_builtin_scene(name)->make();
    const auto places = positions_of(scene);
    for (const LightMotion motion : {LightMotion::none, LightMotion::orbit, LightMotion::drift}) {
      const LightRig rig = make_light_rig(scene, motion);
      EXPECT_TRUE(move_lights(scene, rig, 0).empty());
      EXPECT_EQ(move_lights(scene, rig, 3.7).empty(), motion == LightMotion::none);
      move_lights(scene, rig, 0);
      EXPECT_EQ(positions_of(scene), places) << name;
    }
  }
}

TEST(LightMotions, changes_name_all_point_and_spot_lights) {
  Scene scene = twenty_lights();
  const SceneChanges changes = move_lights(scene, make_light_rig(scene, LightMotion::orbit), 1);
  std::vector<int> all(19);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(changes.lights, all);
  EXPECT_TRUE(changes.instances.empty() && changes.meshes.empty() && changes.cameras.empty());
  EXPECT_EQ(scene.lights[19].position, glm::dvec3(19, 38, -19));
}

TEST(LightMotions, an_orbit_is_a_level_circle_through_the_lights_place) {
  Scene scene = twenty_lights();
  const auto places = positions_of(scene);
  const LightRig rig = make_light_rig(scene, LightMotion::orbit);
  for (size_t i = 0; i < 19; ++i) {
    const double radius_m = i % 2 ? 1.0 : 0.8;  // a fifth of the light's, of at most 5 m
    // The circle through three of its points has the same radius at all times.
    glm::dvec2 points[3];
    for (int k = 0; k < 3; ++k) {
      move_lights(scene, rig, 0.9 * k);
      EXPECT_EQ(scene.lights[i].position.y, places[i].y);
      points[k] = {scene.lights[i].position.x, scene.lights[i].position.z};
    }
    const glm::dvec2 a = points[1] - points[0], b = points[2] - points[0];
    const double area = std::abs(a.x * b.y - a.y * b.x) / 2;
    const double circumradius = glm::length(a) * glm::length(b) * glm::length(b - a) / (4 * area);
    EXPECT_NEAR(circumradius, radius_m, 1e-9) << "light " << i;
  }
}

TEST(LightMotions, lights_stay_near_and_move_slowly) {
  for (const LightMotion motion : {LightMotion::orbit, LightMotion::drift}) {
    Scene scene = twenty_lights();
    const auto places = positions_of(scene);
    const LightRig rig = make_light_rig(scene, motion);
    const double reach = motion == LightMotion::orbit ? 0.4 : 0.7;
    std::vector<glm::dvec3> before = places;
    double farthest = 0;
    for (int frame = 1; frame < 2000; ++frame) {
      move_lights(scene, rig, frame / 60.0);
      for (size_t i = 0; i < 19; ++i) {
        const double radius_m = i % 2 ? 5 : 4;
        const double distance = glm::length(scene.lights[i].position - places[i]) / radius_m;
        farthest = std::max(farthest, distance);
        EXPECT_LE(distance, reach);
        // At most 2 pi radii of an orbit in 4 s.
        EXPECT_LE(glm::length(scene.lights[i].position - before[i]), 0.2 * radius_m * 6.2832 / 4 / 60 * 1.01);
      }
      before = positions_of(scene);
    }
    EXPECT_GT(farthest, reach / 3);
  }
}

TEST(LightMotions, a_lights_motion_depends_on_its_index_and_the_time_alone) {
  Scene few = twenty_lights(), many = twenty_lights();
  few.lights.resize(5);
  const LightRig rig_of_few = make_light_rig(few, LightMotion::drift),
                 rig_of_many = make_light_rig(many, LightMotion::drift);
  move_lights(few, rig_of_few, 9);
  move_lights(few, rig_of_few, 2.5);
  move_lights(many, rig_of_many, 2.5);
  for (size_t i = 0; i < 5; ++i) EXPECT_EQ(few.lights[i].position, many.lights[i].position);
  EXPECT_NE(few.lights[0].position - glm::dvec3(0, 0, 0), few.lights[2].position - glm::dvec3(2, 4, -2));
}

TEST(LightMotions, lights_on_nodes_of_a_rig_are_left_alone) {
  Scene scene = twenty_lights();
  scene.lights[0].node = 3;
  EXPECT_EQ(move_lights(scene, make_light_rig(scene, LightMotion::orbit), 1).lights.front(), 1);
}

TEST(LightMotions, names_and_times_that_do_not_exist_are_refused) {
  EXPECT_EQ(light_motion("orbit"), LightMotion::orbit);
  EXPECT_EQ(light_motion("drift"), LightMotion::drift);
  EXPECT_EQ(light_motion("none"), LightMotion::none);
  EXPECT_THAT([] { light_motion("jump"); },
              testing::ThrowsMessage<Error>("light-motion jump: not none, orbit or drift"));
  Scene scene = twenty_lights();
  EXPECT_THROW(move_lights(scene, make_light_rig(scene, LightMotion::orbit), INFINITY), Error);
}

}  // namespace
}  // namespace lightgrid
