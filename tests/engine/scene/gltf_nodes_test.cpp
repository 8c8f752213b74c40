// Scenes, nodes and skins.

#include "support/gltf_builder.h"
#include "support/near.h"

#include <ctime>

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST(GltfNodes, translation_rotation_and_scale_apply_in_reverse_order) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["translation"] = {10, 20, 30};
  made.node()["rotation"] = {0, 0, root_half, root_half};  // a quarter turn about z: x to y
  made.node()["scale"] = {2, 3, 4};
  const glm::dmat4 world = made.load().instances.at(0).world_from_object;
  expect_near(at(world, {1, 0, 0}), {10, 22, 30});
  expect_near(at(world, {0, 1, 0}), {7, 20, 30});
  expect_near(at(world, {0, 0, 1}), {10, 20, 34});
}

TEST(GltfNodes, a_matrix_is_stored_by_columns_and_children_follow_their_parents) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"children", {1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}},
                        {{"mesh", 0}, {"name", "child"}, {"scale", {-2, 1, 1}}}};
  const Scene scene = made.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].name, "child");
  expect_near(at(scene.instances[0].world_from_object, {1, 1, 1}), {3, 7, 8});
  EXPECT_LT(glm::determinant(scene.instances[0].world_from_object), 0) << "a negative scale is kept";
}

TEST(GltfNodes, matrices_are_double_to_the_end) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"children", {1}}, {"translation", {1e9, 0, 0}}},
                        {{"mesh", 0}, {"translation", {0.125, 0, 0}}}};
  EXPECT_EQ(made.load().instances.at(0).world_from_object[3].x, 1e9 + 0.125);
}

TEST(GltfNodes, a_rotation_that_is_not_unit_is_made_so_and_one_of_no_length_refused) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["rotation"] = {0, 0, 3, 3};
  expect_near(at(made.load().instances.at(0).world_from_object, {1, 0, 0}), {0, 1, 0});
  made.node()["rotation"] = {0, 0, 0, 0};
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: rotation is a quaternion of length 0"));
}

TEST(GltfNodes, matrices_that_are_not_affine_or_not_finite_are_refused) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: matrix has a last row other than 0 0 0 1"));
  made.node()["matrix"] = {1, 0, 0};
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: matrix has 3 numbers instead of 16"));
  made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"children", {1}}, {"scale", {1e200, 1, 1}}},
                        {{"mesh", 0}, {"name", "far"}, {"scale", {1e200, 1, 1}}}};
  EXPECT_THAT(made.refusal(), HasSubstr("node 1 \"far\": its world matrix is not finite"));
}

TEST(GltfNodes, the_chosen_scene_comes_before_the_default_the_first_and_all_roots) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {
      {{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "b"}}, {{"mesh", 0}, {"name", "c"}}};
  made.root["nodes"][2]["children"] = json::array({1});
  made.root["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}};
  made.root["scene"] = 1;
  EXPECT_EQ(made.load({}, 0).instances.at(0).name, "a");
  EXPECT_EQ(made.load().instances.at(0).name, "b");
  EXPECT_EQ(made.refusal({}, 2), "made.gltf: scene 2 was requested, but there are 2");
  made.root.erase("scene");
  EXPECT_EQ(made.load().instances.at(0).name, "a");
  made.root.erase("scenes");
  const Scene all = made.load();
  ASSERT_EQ(all.instances.size(), 3u);
  EXPECT_EQ(all.instances[0].name + all.instances[1].name + all.instances[2].name, "acb") << "depth first";
}

TEST(GltfNodes, loops_and_shared_children_are_refused) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: is reached twice"));
  made.root["nodes"] = {{{"children", {1, 2}}}, {{"children", {2}}}, {{"mesh", 0}}};
  EXPECT_THAT(made.refusal(), HasSubstr("node 2: is reached twice"));
}

TEST(GltfNodes, a_chain_of_a_hundred_thousand_nodes_is_read) {
  GltfBuilder made = GltfBuilder::triangle();
  json& nodes = made.root["nodes"] = json::array();
  for (int i = 0; i < 100'000; ++i) nodes.push_back({{"children", {i + 1}}, {"translation", {0.5, 0, 0}}});
  nodes.push_back({{"mesh", 0}});
  EXPECT_EQ(made.load().instances.at(0).world_from_object[3].x, 50'000);
}

// Processor time of this process.
double seconds_to_load(const GltfBuilder& made, Scene& scene) {
  const ModelFolder folder;
  const auto path = folder.write("made.gltf", made.text());
  const std::clock_t start = std::clock();
  scene = load_gltf(path);
  return double(std::clock() - start) / CLOCKS_PER_SEC;
}

// Each on a node of its own.
double seconds_to_load_lights(int lights) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_lights_punctual"};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const json node = {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
  for (int i = 1; i <= lights; ++i) {
    made.root["nodes"].push_back(node);
    made.root["scenes"][0]["nodes"].push_back(i);
  }
  Scene scene;
  const double seconds = seconds_to_load(made, scene);
  EXPECT_EQ(scene.lights.size(), size_t(lights));
  return seconds;
}

// Each on a mesh of its own, all with one joint.
double seconds_to_load_skins(int skins) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("JOINTS_0", std::vector<uint8_t>(12, 0), "VEC4", u8, 3);
  made.attribute("WEIGHTS_0", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", f32, 3);
  made.root["nodes"] = {json::object()};
  for (int i = 1; i <= skins; ++i) {
    made.root["skins"].push_back({{"joints", {0}}});
    made.root["nodes"].push_back({{"mesh", 0}, {"skin", i - 1}});
    made.root["scenes"][0]["nodes"].push_back(i);
  }
  Scene scene;
  const double seconds = seconds_to_load(made, scene);
  EXPECT_EQ(scene.meshes.size(), size_t(skins));
  return seconds;
}

TEST(GltfNodes, loading_takes_time_in_proportion_to_the_nodes) {
  const double few = seconds_to_load_lights(20'000);
  EXPECT_LT(seconds_to_load_lights(80'000), 8 * few) << "4 is linear, 16 quadratic";
}

TEST(GltfNodes, loading_takes_time_in_proportion_to_the_skins) {
  const double few = seconds_to_load_skins(8'000);
  EXPECT_LT(seconds_to_load_skins(32'000), 8 * few) << "4 is linear, 16 quadratic";
}

TEST(GltfNodes, the_instance_limit_holds) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 0}}};
  EXPECT_EQ(made.load({.max_instances = 2}).instances.size(), 2u);
  EXPECT_THAT(made.refusal({.max_instances = 1}), HasSubstr("node 1: more than 1 instances"));
}

TEST(GltfNodes, indices_out_of_range_are_named_wherever_they_are) {
  const std::pair<const char*, const char*> cases[] = {
      {"/nodes/0/mesh", "node 0: mesh is 7, but there are 1"},
      {"/nodes/0/camera", "node 0: camera is 7, but there are 0"},
      {"/nodes/0/skin", "node 0: skin is 7, but there are 0"},
      {"/scenes/0/nodes/0", "scene 0: node is 7, but there are 1"},
      {"/scene", "scene 7: the default scene is 7, but there are 1"},
      {"/accessors/0/bufferView", "accessor 0: bufferView is 7, but there are 1"},
      {"/bufferViews/0/buffer", "bufferView 0: buffer is 7, but there are 1"},
      {"/meshes/0/primitives/0/material", "mesh 0 primitive 0: material is 7, but there are 0"},
      {"/meshes/0/primitives/0/attributes/NORMAL", "mesh 0 primitive 0: NORMAL is 7, but there are 1"},
  };
  for (const auto& [pointer, message] : cases) {
    GltfBuilder made = GltfBuilder::triangle();
    made.root[json::json_pointer(pointer)] = 7;
    EXPECT_EQ(made.refusal(), std::string("made.gltf: ") + message);
  }
}

TEST(GltfNodes, properties_with_names_of_indices_are_other_programs_where_gltf_has_none) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["asset"]["source"] = "https://example.org/model";
  made.root["asset"]["light"] = {{"node", -3}};
  made.root["scenes"][0]["camera"] = "front";
  made.node()["source"] = 0.5;
  made.node()["material"] = "oak";
  made.node()["attributes"] = {1, "a"};
  made.root["meshes"][0]["index"] = -1;
  made.root["mesh"] = nullptr;
  EXPECT_EQ(made.load().instances.size(), 1u);
}

// Serialisers write it for properties without a value.
TEST(GltfNodes, null_is_no_property) {
  GltfBuilder made = GltfBuilder::triangle();
  for (const char* key :
       {"skin", "camera", "children", "matrix", "name", "rotation", "extensions", "weights"})
    made.node()[key] = nullptr;
  for (const char* key : {"animations", "materials", "skins", "images", "extensionsRequired"})
    made.root[key] = nullptr;
  for (const char* key : {"material", "indices", "mode", "targets"}) made.primitive()[key] = nullptr;
  made.root["bufferViews"][0]["byteStride"] = nullptr;
  const Scene scene = made.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.instances[0].world_from_object, glm::dmat4(1));
}

TEST(GltfNodes, an_index_is_an_integer_from_zero_on) {
  for (const json& value : {json(-1), json(0.5), json("0"), json(4294967296), json(true)}) {
    GltfBuilder made = GltfBuilder::triangle();
    made.node()["mesh"] = value;
    EXPECT_THAT(made.refusal(), HasSubstr("nodes[0].mesh is " + value.dump() + ": not an index"));
  }
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["mesh"] = 0.0;
  EXPECT_EQ(made.load().instances.size(), 1u) << "0.0 is an integer by the specification";
}

// Two joints, the second a metre above the first; the mesh's own node is turned, which must have no effect.
GltfBuilder skinned() {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  made.attribute("JOINTS_0", std::vector<uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4", u8, 3);
  made.attribute("WEIGHTS_0", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, "VEC4", f32, 3);
  made.root["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                        {{"children", {2}}, {"translation", {0, 0, 5}}},
                        {{"translation", {0, 1, 0}}}};
  made.root["scenes"][0]["nodes"] = {0, 1};
  made.root["skins"] = {{{"joints", {1, 2}}}};
  return made;
}

TEST(GltfSkins, a_skinned_mesh_is_placed_by_its_joints_at_rest) {
  GltfBuilder made = skinned();
  const Scene scene = made.load();
  EXPECT_EQ(scene.instances.at(0).world_from_object, glm::dmat4(1));
  EXPECT_THAT(scene.meshes.at(0).positions,
              testing::ElementsAre(glm::vec3(0, 0, 5), glm::vec3(1, 1, 5), glm::vec3(0, 1.5f, 5)));
  EXPECT_EQ(scene.meshes[0].bounds.max, glm::vec3(1, 1.5f, 5));
}

TEST(GltfSkins, inverse_bind_matrices_undo_the_joints_at_rest) {
  GltfBuilder made = skinned();
  const std::vector<float> undo = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0,  -5, 1,
                                   1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, -5, 1};
  made.root["skins"][0]["inverseBindMatrices"] = made.accessor(made.view(bytes_of(undo)), "MAT4", f32, 2);
  EXPECT_THAT(made.load().meshes.at(0).positions,
              testing::ElementsAre(glm::vec3(0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)));
  made.root["accessors"].back()["count"] = 1;
  EXPECT_THAT(made.refusal(),
              HasSubstr("skin 0: inverseBindMatrices has 1 elements of 16 components for 2 joints"));
}

TEST(GltfSkins, joints_out_of_range_or_out_of_the_scene_are_refused) {
  GltfBuilder made = skinned();
  made.root["skins"][0]["joints"] = {1};
  EXPECT_THAT(made.refusal(), HasSubstr("vertex 1: joint 1, but the skin has 1"));
  made = skinned();
  made.root["scenes"][0]["nodes"] = {0};
  EXPECT_THAT(made.refusal(), HasSubstr("skin 0: joint 1 is not in the scene"));
}

TEST(GltfSkins, a_skin_without_joints_is_refused_only_if_a_mesh_uses_it) {
  GltfBuilder made = skinned();
  made.root["skins"].push_back(json::object());
  EXPECT_EQ(made.load().meshes.size(), 1u);
  made.node()["skin"] = 1;
  EXPECT_EQ(made.refusal(), "made.gltf: skin 1: has no joints");
}

}  // namespace
}  // namespace lightgrid
