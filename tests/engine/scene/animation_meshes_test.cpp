// Skins and morph targets at a time: vertices computed by hand.
#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_inverse.hpp>

#include "scene/rig.h"
#include "support/animated_gltf.h"

namespace lightgrid {
namespace {

using Ints = std::vector<int>;
using Floats = std::vector<float>;
using Points = std::vector<glm::vec3>;

void expect_points(const Points& actual, const Points& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i)
    expect_near(glm::dvec3(actual[i]), glm::dvec3(expected[i]), 2e-7);
}

// A mesh's arrays, bit for bit.
void expect_same_mesh(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.normals, b.normals);
  EXPECT_EQ(a.tangents, b.tangents);
  EXPECT_EQ(a.uv0, b.uv0);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.indices, b.indices);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.bounds.min, b.bounds.min);
  EXPECT_EQ(a.bounds.max, b.bounds.max);
}

// The triangle (0,0,0), (1,0,0), (0,1,0) with normals z: corner 0 on joint node 1, corner 1 on node 2 (a
// metre above it), corner 2 on both alike. Node 0 draws it and is moved away, which has no effect. Inverse
// binds undo the joints at rest.
GltfBuilder two_joints() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  made.attribute("JOINTS_0", std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", u8, 3);
  made.attribute("WEIGHTS_0", Floats{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", f32, 3);
  made.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                        {{"children", {2}}},
                        {{"translation", {0, 1, 0}}}};
  made.root["scenes"][0]["nodes"] = {0, 1};
  const Floats undo = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  0, 1,
                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1};
  const int binds = made.accessor(made.view(bytes_of(undo)), "MAT4", f32, 2);
  made.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binds}}};
  return made;
}

void add_normal_map(GltfBuilder& made) {
  made.attribute("TEXCOORD_0", Floats{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  made.root["textures"] = {{{"source", 0}}};
  made.root["images"] = {
      {{"uri",
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC"}}};
  made.primitive()["material"] = 0;
}

TEST(AnimationSkins, joints_move_vertices_and_normals) {
  GltfBuilder made = two_joints();
  // The upper joint turns to a quarter about x (y to z, z to -y).
  animate(made, 2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, float(root_half), 0, 0, float(root_half)});
  Scene scene = made.load();
  const Mesh at_rest = scene.meshes.at(0);
  expect_points(at_rest.positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const SceneChanges changes = set_time(scene, 1);
  EXPECT_EQ(changes.meshes, Ints{0});
  EXPECT_TRUE(changes.instances.empty());
  const Mesh& mesh = scene.meshes[0];
  // Corner 1, a metre below its joint at (0,1,0): from it (1,-1,0) becomes (1,0,-1). Corner 2 is at the joint
  // in both poses.
  expect_points(mesh.positions, {{0, 0, 0}, {1, 1, -1}, {0, 1, 0}});
  const float diagonal = float(root_half);
  expect_points(mesh.normals, {{0, 0, 1}, {0, -1, 0}, {0, -diagonal, diagonal}});
  EXPECT_EQ(mesh.bounds.min, glm::vec3(0, std::min(mesh.positions[0].y, 0.0f), mesh.positions[1].z));
  EXPECT_TRUE(set_time(scene, 1).empty());
  EXPECT_EQ(set_time(scene, std::nullopt).meshes, Ints{0});
  expect_same_mesh(scene.meshes[0], at_rest);
}

TEST(AnimationSkins, half_of_each_joint_moves_half_as_far) {
  GltfBuilder made = two_joints();
  animate(made, 2, "translation", {0, 2}, "VEC3", {0, 1, 0, 4, 1, 0});
  Scene scene = made.load();
  set_time(scene, 1);
  expect_points(scene.meshes[0].positions, {{0, 0, 0}, {3, 0, 0}, {1, 1, 0}});
  EXPECT_EQ(scene.meshes[0].bounds.max, glm::vec3(3, 1, 0));
}

TEST(AnimationSkins, a_node_above_the_joints_moves_them_all) {
  GltfBuilder made = two_joints();
  animate(made, 1, "translation", {0, 1}, "VEC3", {0, 0, 0, 0, 0, 6});
  Scene scene = made.load();
  set_time(scene, 0.5);
  expect_points(scene.meshes[0].positions, {{0, 0, 3}, {1, 0, 3}, {0, 1, 3}});
  EXPECT_EQ(scene.instances[0].world_from_object, glm::dmat4(1));
}

TEST(AnimationSkins, the_drawing_nodes_own_motion_has_no_effect) {
  GltfBuilder made = two_joints();
  animate(made, 0, "translation", {0, 1}, "VEC3", {0, 0, 0, 0, 0, 6});
  Scene scene = made.load();
  EXPECT_TRUE(set_time(scene, 0.5).empty());
  ASSERT_NE(scene.rig, nullptr);
  EXPECT_TRUE(scene.rig->meshes.empty()) << "its joints never move";
}

using Corners = std::vector<glm::dvec3>;

// The corners of an instance's triangles in world space, counter-clockwise in front.
Corners front_corners(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = scene.meshes.at(size_t(instance.mesh));
  Corners corners;
  for (const uint32_t index : mesh.indices)
    corners.emplace_back(instance.world_from_object * glm::dvec4(mesh.positions[index], 1));
  if (glm::determinant(glm::dmat3(instance.world_from_object)) < 0)
    for (size_t i = 0; i + 2 < corners.size(); i += 3) std::swap(corners[i + 1], corners[i + 2]);
  return corners;
}

void expect_corners(const Scene& scene, size_t instance, const Corners& expected) {
  const Corners actual = front_corners(scene, scene.instances.at(instance));
  ASSERT_EQ(actual.size(), expected.size());
  for (size_t i = 0; i < actual.size(); ++i) expect_near(actual[i], expected[i], 2e-7);
}

glm::dvec3 world_normal(const Scene& scene, size_t instance, size_t vertex) {
  const Instance& drawn = scene.instances.at(instance);
  return glm::normalize(glm::inverseTranspose(glm::dmat3(drawn.world_from_object)) *
                        glm::dvec3(scene.meshes[size_t(drawn.mesh)].normals[vertex]));
}

// two_joints() under node 3, the root.
GltfBuilder under_a_root(const nlohmann::json& root) {
  GltfBuilder made = two_joints();
  made.root["nodes"].push_back(root);
  made.root["nodes"][3]["children"] = {0, 1};
  made.root["scenes"][0]["nodes"] = {3};
  return made;
}

// glTF 2.0, section 3.7.4: with a negative determinant of the node, front faces are clockwise.
TEST(AnimationSkins, under_a_mirrored_root_front_faces_are_mirrored_too) {
  const Scene scene = under_a_root({{"scale", {-1, 1, 1}}}).load();
  expect_corners(scene, 0, {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
  for (size_t i = 0; i < 3; ++i) expect_near(world_normal(scene, 0, i), {0, 0, 1}, 1e-7);
}

TEST(AnimationSkins, only_the_drawing_nodes_determinant_gives_the_winding) {
  GltfBuilder made = two_joints();
  made.root["nodes"][1]["scale"] = {-1, 1, 1};
  const Scene joints = made.load();
  expect_corners(joints, 0, {{0, 0, 0}, {-1, 0, 0}, {0, 1, 0}});
  // The normals stay those of the file's front, which this file turns away.
  for (size_t i = 0; i < 3; ++i) expect_near(world_normal(joints, 0, i), {0, 0, 1}, 1e-7);

  made = two_joints();
  made.root["nodes"][0]["scale"] = {-1, 1, 1};
  made.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  made.root["scenes"][0]["nodes"] = {0, 1, 3};
  const Scene node = made.load();
  expect_corners(node, 0, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  expect_corners(node, 1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(AnimationSkins, a_vertex_without_weights_stays_in_place_when_mirrored) {
  GltfBuilder made = two_joints();
  made.attribute("WEIGHTS_0", Floats(12, 0), "VEC4", f32, 3);
  made.root["nodes"][0]["scale"] = {-1, 1, 1};
  expect_corners(made.load(), 0, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
}

TEST(AnimationSkins, an_animated_scale_turns_the_winding_and_back) {
  GltfBuilder made = under_a_root({{"name", "root"}});
  animate(made, 3, "scale", {0, 2}, "VEC3", {1, 1, 1, -1, 1, 1});
  Scene scene = made.load();
  const Corners rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  expect_corners(scene, 0, rest);
  SceneChanges changes = set_time(scene, 2);
  EXPECT_EQ(changes.instances, Ints{0});
  EXPECT_EQ(changes.meshes, Ints{0});
  expect_corners(scene, 0, {{0, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
  expect_near(world_normal(scene, 0, 0), {0, 0, 1}, 1e-7);
  changes = set_time(scene, 0);
  EXPECT_EQ(changes.instances, Ints{0});
  expect_corners(scene, 0, rest);
}

TEST(AnimationSkins, a_scaled_node_with_resting_joints_turns_only_its_own_winding) {
  GltfBuilder made = two_joints();
  made.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  made.root["scenes"][0]["nodes"] = {0, 1, 3};
  animate(made, 0, "scale", {0, 2}, "VEC3", {1, 1, 1, 1, -1, 1});
  Scene scene = made.load();
  set_time(scene, 2);
  expect_corners(scene, 0, {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  expect_corners(scene, 1, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(AnimationSkins, morph_targets_of_a_mirrored_mesh_move_in_its_file_space) {
  GltfBuilder made = under_a_root({{"scale", {-1, 1, 1}}});
  made.primitive()["targets"] = {
      {{"POSITION", float_accessor(made, "VEC3", 3, {1, 0, 0, 0, 0, 0, 0, 0, 0})}}};
  made.root["meshes"][0]["weights"] = {0};
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 1});
  Scene scene = made.load();
  set_time(scene, 1);
  expect_corners(scene, 0, {{-1, 0, 0}, {0, 1, 0}, {-1, 0, 0}});
}

TEST(AnimationSkins, joints_that_mirror_turn_the_handedness_of_tangents) {
  GltfBuilder made = two_joints();
  made.attribute("TANGENT", Floats{1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1}, "VEC4", f32, 3);
  add_normal_map(made);
  made.root["nodes"][1]["scale"] = {-1, 1, 1};
  const Scene joints = made.load();
  EXPECT_EQ(joints.meshes[0].tangents[0], glm::vec4(-1, 0, 0, -1));
  made.root["nodes"][0]["scale"] = {1, 1, -1};  // the instance's own matrix mirrors: the file's handedness
  EXPECT_EQ(made.load().meshes[0].tangents[0], glm::vec4(1, 0, 0, 1));
}

TEST(AnimationSkins, instances_of_one_skin_share_a_mesh_and_other_skins_have_their_own) {
  GltfBuilder made = two_joints();
  made.root["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  made.root["nodes"].push_back({{"mesh", 0}, {"skin", 1}});
  made.root["nodes"].push_back({{"mesh", 0}});
  made.root["scenes"][0]["nodes"] = {0, 1, 3, 4, 5};
  made.root["skins"].push_back({{"joints", {2, 1}}});
  animate(made, 2, "translation", {0, 2}, "VEC3", {0, 1, 0, 4, 1, 0});
  Scene scene = made.load();
  ASSERT_EQ(scene.meshes.size(), 3u);
  ASSERT_EQ(scene.instances.size(), 4u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[1].mesh);
  EXPECT_EQ(set_time(scene, 1).meshes, (Ints{0, 1}));
  expect_points(scene.meshes[0].positions, {{0, 0, 0}, {3, 0, 0}, {1, 1, 0}});
  // The second skin has its joints swapped and no inverse binds: corner 0 is on node 2, at (2, 1, 0), corner
  // 1 on node 1.
  expect_points(scene.meshes[1].positions, {{2, 1, 0}, {1, 0, 0}, {1, 1.5f, 0}});
  expect_points(scene.meshes[2].positions, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  EXPECT_EQ(scene.rig->meshes.size(), 2u);
}

TEST(AnimationSkins, tangents_turn_and_keep_their_handedness) {
  GltfBuilder made = two_joints();
  made.attribute("TANGENT", Floats{1, 0, 0, -1, 0, 1, 0, -1, 1, 0, 0, 1}, "VEC4", f32, 3);
  add_normal_map(made);
  animate(made, 2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, float(root_half), 0, 0, float(root_half)});
  Scene scene = made.load();
  const Mesh at_rest = scene.meshes[0];
  set_time(scene, 1);
  expect_near(glm::dvec3(scene.meshes[0].tangents[1]), {0, 0, 1}, 2e-7);
  EXPECT_EQ(scene.meshes[0].tangents[1].w, -1);
  EXPECT_EQ(scene.meshes[0].tangents[2].w, 1);
  set_time(scene, std::nullopt);
  expect_same_mesh(scene.meshes[0], at_rest);
}

// One target lifts corner 1 by 2, the other moves all corners by (4, 8, 0); rest weights 0.5 and 0.25.
GltfBuilder two_targets_at_rest() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  const int lift = float_accessor(made, "VEC3", 3, {0, 0, 0, 0, 0, 2, 0, 0, 0});
  const int move = float_accessor(made, "VEC3", 3, {4, 8, 0, 4, 8, 0, 4, 8, 0});
  const int tilt = float_accessor(made, "VEC3", 3, {4, 0, 2, 0, 0, 0, 0, 0, 0});
  made.primitive()["targets"] = {{{"POSITION", lift}}, {{"POSITION", move}, {"NORMAL", tilt}}};
  made.root["meshes"][0]["weights"] = {0.5, 0.25};
  return made;
}

TEST(AnimationMorphs, weights_run_between_keys) {
  GltfBuilder made = two_targets_at_rest();
  animate(made, 0, "weights", {1, 3}, "SCALAR", {0, 0, 1, -0.5f});
  Scene scene = made.load();
  const Mesh at_rest = scene.meshes.at(0);
  expect_points(at_rest.positions, {{1, 2, 0}, {2, 2, 1}, {1, 3, 0}});
  EXPECT_EQ(set_time(scene, 2).meshes, Ints{0});
  // Weights 0.5 and -0.25.
  expect_points(scene.meshes[0].positions, {{-1, -2, 0}, {0, -2, 1}, {-1, -1, 0}});
  // (0, 0, 1) - (4, 0, 2) / 4 = (-1, 0, 0.5).
  const float length = std::sqrt(1.25f);
  expect_points(scene.meshes[0].normals, {{-1 / length, 0, 0.5f / length}, {0, 0, 1}, {0, 0, 1}});
  EXPECT_EQ(scene.meshes[0].bounds.min, glm::vec3(-1, -2, 0));
  EXPECT_EQ(set_time(scene, 1).meshes, Ints{0});
  EXPECT_EQ(scene.meshes[0].positions, (Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  set_time(scene, std::nullopt);
  expect_same_mesh(scene.meshes[0], at_rest);
}

TEST(AnimationMorphs, cubic_splines_store_all_tangents_of_a_key_before_its_values) {
  GltfBuilder made = two_targets_at_rest();
  // A second apart; both weights 0 with out-tangents 8 and 0, then 1 and 0 with in-tangents 0. At 1/2: 8 / 8
  // + 1/2 and 0.
  animate(made, 0, "weights", {0, 1}, "SCALAR", {5, 5, 0, 0, 8, 0, 0, 0, 1, 0, 5, 5}, "CUBICSPLINE");
  Scene scene = made.load();
  set_time(scene, 0.5);
  expect_points(scene.meshes[0].positions, {{0, 0, 0}, {1, 0, 3}, {0, 1, 0}});
}

TEST(AnimationMorphs, integer_weights_are_normalised) {
  GltfBuilder made = two_targets_at_rest();
  nlohmann::json& sampler = animate(made, 0, "weights", {0}, "SCALAR", {0, 0});
  const int bytes = made.accessor(made.view(bytes_of(std::vector<uint8_t>{51, 0})), "SCALAR", u8, 2, true);
  sampler["output"] = bytes;
  Scene scene = made.load();
  set_time(scene, 1);
  expect_points(scene.meshes[0].positions, {{0, 0, 0}, {1, 0, 0.4f}, {0, 1, 0}});
}

TEST(AnimationMorphs, a_node_with_animated_weights_does_not_move_others_of_its_mesh) {
  GltfBuilder made = two_targets_at_rest();
  made.root["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}}};
  made.root["scenes"][0]["nodes"] = {0, 1, 2};
  animate(made, 1, "weights", {0, 1}, "SCALAR", {0, 0, 1, 0});
  Scene scene = made.load();
  ASSERT_EQ(scene.meshes.size(), 2u);
  EXPECT_EQ(scene.instances[0].mesh, scene.instances[2].mesh);
  EXPECT_EQ(set_time(scene, 1).meshes, Ints{scene.instances[1].mesh});
  expect_points(scene.meshes[scene.instances[1].mesh].positions, {{0, 0, 0}, {1, 0, 2}, {0, 1, 0}});
  expect_points(scene.meshes[scene.instances[0].mesh].positions, {{1, 2, 0}, {2, 2, 1}, {1, 3, 0}});
}

TEST(AnimationMorphs, targets_come_before_the_skin) {
  GltfBuilder made = two_joints();
  const int lift = float_accessor(made, "VEC3", 3, {0, 0, 0, 0, 0, 2, 0, 0, 0});
  made.primitive()["targets"] = {{{"POSITION", lift}}};
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 1});
  animate(made, 2, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, float(root_half), 0, 0, float(root_half)});
  Scene scene = made.load();
  set_time(scene, 1);
  // Corner 1 is at (1, 0, 2); from its joint (1, -1, 2) turns to (1, -2, -1).
  expect_points(scene.meshes[0].positions, {{0, 0, 0}, {1, -1, -1}, {0, 1, 0}});
}

TEST(AnimationMorphs, flat_normals_and_made_tangents_are_those_of_the_present_shape) {
  GltfBuilder made = GltfBuilder::triangle();
  const int stand_up = float_accessor(made, "VEC3", 3, {0, 0, 0, 0, 0, 0, 0, -1, 1});
  made.primitive()["targets"] = {{{"POSITION", stand_up}}};
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 1});
  Scene scene = made.load();
  EXPECT_EQ(scene.meshes[0].normals.at(0), glm::vec3(0, 0, 1));
  set_time(scene, 1);
  // (1, 0, 0) x (0, 0, 1) = (0, -1, 0).
  EXPECT_EQ(scene.meshes[0].normals.at(0), glm::vec3(0, -1, 0));
}

TEST(AnimationMorphs, texture_coordinates_and_colours_change_too) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("TEXCOORD_0", Floats{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.attribute("COLOR_0", Floats{0.5, 0.5, 0.5, 0, 0, 0, 0, 0, 0}, "VEC3", f32, 3);
  made.primitive()["targets"] = {
      {{"TEXCOORD_0", float_accessor(made, "VEC2", 2, {0.25, 0.5, 0, 0, 0, 0})},
       {"COLOR_0", float_accessor(made, "VEC3", 3, {1, -0.25, -2, 0, 0, 0, 0, 0, 0})}}};
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 1});
  Scene scene = made.load();
  set_time(scene, 1);
  EXPECT_EQ(scene.meshes[0].uv0.at(0), glm::vec2(0.25, 0.5));
  EXPECT_EQ(scene.meshes[0].colors.at(0), glm::vec4(1, 0.25, 0, 1));
}

TEST(AnimationMorphs, meshes_that_keep_their_shape_are_not_kept_twice) {
  GltfBuilder made = two_targets_at_rest();
  animate(made, 0, "translation", {0, 1}, "VEC3", {0, 0, 0, 1, 1, 1});
  EXPECT_TRUE(made.load().rig->meshes.empty());
}

TEST(AnimationMorphs, a_vertex_moved_to_infinity_is_refused_and_the_next_pose_is_whole) {
  GltfBuilder made = two_targets_at_rest();
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 0, 3e38f, 3e38f});
  Scene scene = made.load();
  const Mesh at_rest = scene.meshes[0];
  EXPECT_THAT([&] { set_time(scene, 1); },
              testing::ThrowsMessage<Error>(
                  testing::HasSubstr("made.gltf: mesh 0 primitive 0: vertex 0 is moved to infinity at 1 s")));
  EXPECT_EQ(set_time(scene, std::nullopt).meshes, Ints{0});
  expect_same_mesh(scene.meshes[0], at_rest);
}

}  // namespace
}  // namespace lightgrid
