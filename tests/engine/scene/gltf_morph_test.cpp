// Morph targets at their default weights: values worked out by hand.
#include <cmath>

#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using testing::HasSubstr;
using Floats = std::vector<float>;

// The triangle (0,0,0), (1,0,0), (0,1,0) with normals +z and two targets: one lifts the second corner by 2,
// the other moves all corners by (4, 8, 0) and tilts the first normal.
GltfBuilder two_targets() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", Floats{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  const auto vec3 = [&](const Floats& values) {
    return made.accessor(made.view(bytes_of(values)), "VEC3", f32, 3);
  };
  const int lift = vec3({0, 0, 0, 0, 0, 2, 0, 0, 0}), move = vec3({4, 8, 0, 4, 8, 0, 4, 8, 0});
  const int tilt = vec3({4, 0, 2, 0, 0, 0, 0, 0, 0});
  made.primitive()["targets"] = {{{"POSITION", lift}}, {{"POSITION", move}, {"NORMAL", tilt}}};
  return made;
}

TEST(GltfMorph, the_meshs_weights_move_positions_and_normals) {
  GltfBuilder made = two_targets();
  made.root["meshes"][0]["weights"] = {0.5, 0.25};
  const Mesh mesh = made.load().meshes.at(0);
  // Half of (0, 0, 2) on the second corner, and a quarter of (4, 8, 0) on all.
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{1, 2, 0}, {2, 2, 1}, {1, 3, 0}}));
  // (0, 0, 1) + (4, 0, 2) / 4 = (1, 0, 1.5), of length sqrt(3.25).
  const double length = std::sqrt(3.25);
  EXPECT_EQ(mesh.normals[0], glm::vec3(1 / length, 0, 1.5 / length));
  EXPECT_EQ(mesh.normals[1], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.bounds.min, glm::vec3(1, 2, 0));
  EXPECT_EQ(mesh.bounds.max, glm::vec3(2, 3, 1));
}

TEST(GltfMorph, the_nodes_weights_come_before_its_meshs) {
  GltfBuilder made = two_targets();
  made.root["meshes"][0]["weights"] = {0.5, 0.25};
  made.root["nodes"] = {
      {{"mesh", 0}, {"weights", {1, 0}}}, {{"mesh", 0}}, {{"mesh", 0}, {"weights", {1, 0}}}};
  made.root["scenes"][0]["nodes"] = {0, 1, 2};
  const Scene scene = made.load();
  ASSERT_EQ(scene.meshes.size(), 2u) << "equal weights share a mesh";
  ASSERT_EQ(scene.instances.size(), 3u);
  EXPECT_EQ(scene.meshes[scene.instances[0].mesh].positions[1], glm::vec3(1, 0, 2));
  EXPECT_EQ(scene.meshes[scene.instances[1].mesh].positions[1], glm::vec3(2, 2, 1));
  EXPECT_EQ(scene.instances[2].mesh, scene.instances[0].mesh);
}

TEST(GltfMorph, no_weights_and_zeros_leave_the_base_shape) {
  GltfBuilder made = two_targets();
  EXPECT_EQ(made.load().meshes.at(0).positions[1], glm::vec3(1, 0, 0));
  made.root["meshes"][0]["weights"] = {0, 0};
  EXPECT_EQ(made.load().meshes.at(0).positions[1], glm::vec3(1, 0, 0));
}

TEST(GltfMorph, weights_may_be_negative_or_above_one) {
  GltfBuilder made = two_targets();
  made.root["meshes"][0]["weights"] = {-1.5, 0};
  EXPECT_EQ(made.load().meshes.at(0).positions[1], glm::vec3(1, 0, -3));
}

TEST(GltfMorph, a_sparse_target_without_a_view_moves_only_the_vertices_it_names) {
  GltfBuilder made = GltfBuilder::triangle();
  const int target = made.accessor(-1, "VEC3", f32, 3);
  made.root["accessors"][target]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", made.view(bytes_of(std::vector<uint16_t>{2}))}, {"componentType", int(u16)}}},
      {"values", {{"bufferView", made.view(bytes_of(Floats{6, 0, 2}))}}}};
  made.primitive()["targets"] = {{{"POSITION", target}}};
  made.root["meshes"][0]["weights"] = {0.5};
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_EQ(mesh.positions, (std::vector<glm::vec3>{{0, 0, 0}, {1, 0, 0}, {3, 1, 1}}));
}

TEST(GltfMorph, flat_normals_are_those_of_the_morphed_triangle) {
  GltfBuilder made = GltfBuilder::triangle();
  const int stand_up = made.accessor(made.view(bytes_of(Floats{0, 0, 0, 0, 0, 0, 0, -1, 1})), "VEC3", f32, 3);
  made.primitive()["targets"] = {{{"POSITION", stand_up}}};
  made.root["meshes"][0]["weights"] = {1};
  // (1, 0, 0) x (0, 0, 1) = (0, -1, 0).
  EXPECT_EQ(made.load().meshes.at(0).normals.at(0), glm::vec3(0, -1, 0));
}

TEST(GltfMorph, tangents_keep_their_handedness_and_colours_their_range) {
  GltfBuilder made = two_targets();
  made.attribute("TANGENT", Floats{1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, "VEC4", f32, 3);
  made.attribute("TEXCOORD_0", Floats{0, 0, 1, 0, 0, 1}, "VEC2", f32, 3);
  made.attribute("COLOR_0", Floats{0.5, 0.5, 0.5, 0, 0, 0, 0, 0, 0}, "VEC3", f32, 3);
  made.root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  made.root["textures"] = {{{"source", 0}}};
  made.root["images"] = {
      {{"uri",
        "data:image/png;base64,"
        "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR4nGNgYGAAAAAEAAH2FzhVAAAAAElFTkSuQmCC"}}};
  made.primitive()["material"] = 0;
  const auto add = [&](const char* type, const Floats& values) {
    return made.accessor(made.view(bytes_of(values)), type, f32, 3);
  };
  made.primitive()["targets"] = {{{"TANGENT", add("VEC3", {-1, 2, 0, 0, 0, 0, 0, 0, 0})},
                                  {"TEXCOORD_0", add("VEC2", {0.25, 0.5, 0, 0, 0, 0})},
                                  {"COLOR_0", add("VEC3", {1, -0.25, -2, 0, 0, 0, 0, 0, 0})}}};
  made.root["meshes"][0]["weights"] = {1};
  const Mesh mesh = made.load().meshes.at(0);
  EXPECT_EQ(mesh.tangents.at(0), glm::vec4(0, 1, 0, -1));
  EXPECT_EQ(mesh.tangents.at(1), glm::vec4(1, 0, 0, -1));
  EXPECT_EQ(mesh.uv0.at(0), glm::vec2(0.25, 0.5));
  EXPECT_EQ(mesh.colors.at(0), glm::vec4(1, 0.25, 0, 1));
}

TEST(GltfMorph, weights_and_targets_that_do_not_fit_are_refused_by_name) {
  GltfBuilder made = two_targets();
  made.root["meshes"][0]["weights"] = {0.5};
  EXPECT_THAT(made.refusal(), HasSubstr("mesh 0 primitive 0: there are 1 weights for 2 morph targets"));

  made = GltfBuilder::triangle();
  made.primitive()["targets"] = {{{"POSITION", 1}}};
  made.root["meshes"][0]["weights"] = {1};
  EXPECT_THAT(made.refusal(), HasSubstr("target POSITION is 1, but there are 1"));
  made.accessor(made.view(bytes_of(Floats{1, 2, 3, 4, 5, 6})), "VEC3", f32, 2);
  EXPECT_THAT(made.refusal(), HasSubstr("target 0 POSITION: has 2 elements, but there are 3 vertices"));

  made = two_targets();
  made.root["meshes"][0]["weights"] = {3e38, 3e38};
  EXPECT_THAT(made.refusal(), HasSubstr("its morph targets move a vertex to infinity"));
}

}  // namespace
}  // namespace lightgrid
