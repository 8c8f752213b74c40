// Lights and cameras on nodes that move.
#include <cmath>

#include "support/animated_gltf.h"

namespace lightgrid {
namespace {

using Ints = std::vector<int>;

// Node 0: a triangle. Node 1 moves along x and turns about x from none to 180 degrees; on it: 2, a spot 1 m
// ahead of it; 3, a camera. Node 4: a point light that stays.
GltfBuilder carried() {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}, {"range", 4}},
      {{"type", "point"}, {"intensity", 3}}};
  const auto light = [](int index) { return nlohmann::json{{"KHR_lights_punctual", {{"light", index}}}}; };
  made.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  made.root["nodes"] = {{{"mesh", 0}},
                        {{"children", {2, 3}}},
                        {{"translation", {0, 0, -1}}, {"extensions", light(0)}},
                        {{"camera", 0}},
                        {{"translation", {7, 7, 7}}, {"extensions", light(1)}}};
  made.root["scenes"][0]["nodes"] = {0, 1, 4};
  animate(made, 1, "translation", {0, 2}, "VEC3", {0, 0, 0, 4, 0, 0});
  animate(made, 1, "rotation", {0, 2}, "VEC4", {0, 0, 0, 1, 1, 0, 0, 0});
  return made;
}

TEST(AnimationLights, lights_and_cameras_follow_their_nodes) {
  Scene scene = carried().load();
  ASSERT_EQ(scene.lights.size(), 2u);
  const SceneChanges changes = set_time(scene, 1);
  EXPECT_EQ(changes.lights, Ints{0});
  EXPECT_EQ(changes.cameras, Ints{0});
  EXPECT_TRUE(changes.instances.empty() && changes.meshes.empty());
  // A quarter turn about x takes -z to y: the spot is 1 m above the node, which is at (2, 0, 0).
  const Light& spot = scene.lights[0];
  expect_near(spot.position, {2, 1, 0});
  expect_near(glm::dvec3(spot.direction), {0, 1, 0}, 1e-7);
  EXPECT_EQ(spot.radius_m, 4);
  expect_near(scene.lights[1].position, {7, 7, 7});
  const glm::dmat4& camera = scene.cameras[0].world_from_view;
  expect_near(glm::dvec3(camera[0]), {1, 0, 0});
  expect_near(glm::dvec3(camera[1]), {0, 0, 1});
  expect_near(glm::dvec3(camera[2]), {0, -1, 0});
  expect_near(glm::dvec3(camera[3]), {2, 0, 0});
  // At 2 s: half a turn.
  set_time(scene, 2);
  expect_near(scene.lights[0].position, {4, 0, 1});
  expect_near(glm::dvec3(scene.lights[0].direction), {0, 0, 1}, 1e-7);
}

TEST(AnimationLights, lights_that_the_caller_replaces_stay) {
  Scene scene = carried().load();
  scene.lights = {Light{.position = {1, 2, 3}}};
  EXPECT_TRUE(set_time(scene, 1).lights.empty());
  expect_near(scene.lights[0].position, {1, 2, 3});
}

TEST(AnimationLights, scale_changes_neither_range_nor_cone_and_cameras_stay_rigid) {
  GltfBuilder made = carried();
  animate(made, 1, "scale", {0, 2}, "VEC3", {1, 1, 1, 5, 9, 5});
  Scene scene = made.load();
  set_time(scene, 2);
  EXPECT_EQ(scene.lights[0].radius_m, 4);
  EXPECT_EQ(scene.lights[0].outer_cone_rad, 0.5f);
  expect_near(scene.lights[0].position, {4, 0, 5});
  expect_near(glm::dvec3(scene.cameras[0].world_from_view[1]), {0, -1, 0});
}

TEST(AnimationLights, a_node_scaled_to_nothing_leaves_the_directions_at_rest) {
  GltfBuilder made = carried();
  animate(made, 1, "scale", {0, 2}, "VEC3", {1, 1, 1, 0, 0, 0});
  Scene scene = made.load();
  set_time(scene, 1);
  set_time(scene, 2);
  expect_near(scene.lights[0].position, {4, 0, 0});
  expect_near(glm::dvec3(scene.lights[0].direction), {0, 0, -1}, 1e-7);
  EXPECT_EQ(glm::dmat3(scene.cameras[0].world_from_view), glm::dmat3(1));
  expect_near(glm::dvec3(scene.cameras[0].world_from_view[3]), {4, 0, 0});
}

TEST(AnimationLights, rest_restores_them_bit_for_bit) {
  const Scene loaded = carried().load();
  Scene scene = loaded;
  set_time(scene, 1.3);
  set_time(scene, std::nullopt);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(scene.lights[i].position, loaded.lights[i].position);
    EXPECT_EQ(scene.lights[i].direction, loaded.lights[i].direction);
  }
  EXPECT_EQ(scene.cameras[0].world_from_view, loaded.cameras[0].world_from_view);
}

}  // namespace
}  // namespace lightgrid
