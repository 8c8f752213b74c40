// Animations of a file: which are read, and which are left out with a warning.
#include "scene/rig.h"
#include "support/animated_gltf.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

// A triangle that moves by (1, 0, 0) in a second.
GltfBuilder animated() {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "translation", {0, 1}, "VEC3", {0, 0, 0, 1, 0, 0});
  return made;
}

json& sampler_of(GltfBuilder& made) { return made.root["animations"][0]["samplers"][0]; }
json& channel_of(GltfBuilder& made) { return made.root["animations"][0]["channels"][0]; }

// Replaces the times of animated().
void set_times(GltfBuilder& made, const std::vector<float>& times) {
  sampler_of(made)["input"] = float_accessor(made, "SCALAR", 1, times);
}

// The warning with which the file's one animation is left out, without the folder. Everything else loads, and
// nothing moves.
std::string left_out(const GltfBuilder& made, const GltfLimits& limits = {}) {
  Scene scene;
  const std::string warning = warnings_of([&] { scene = made.load(limits); });
  EXPECT_EQ(scene.instances.size(), 1u);
  EXPECT_EQ(scene.rig, nullptr);
  EXPECT_TRUE(set_time(scene, 0.5).empty());
  EXPECT_EQ(std::count(warning.begin(), warning.end(), '\n'), 1) << warning;
  const size_t file = warning.find("made.gltf"), end = warning.find("; this animation is left out\n");
  EXPECT_NE(end, std::string::npos) << warning;
  return warning.substr(std::min(file, warning.size()), end - file);
}

TEST(GltfAnimation, names_and_keys_are_kept) {
  GltfBuilder made = animated();
  made.root["animations"][0]["name"] = "walk";
  std::string warnings;
  Scene scene;
  warnings = warnings_of([&] { scene = made.load(); });
  EXPECT_THAT(warnings, IsEmpty());
  ASSERT_EQ(animation_count(scene), 1);
  EXPECT_EQ(scene.rig->animations[0].name, "walk");
  EXPECT_EQ(scene.rig->animations[0].channels.at(0).times, (std::vector<float>{0, 1}));
  EXPECT_EQ(scene.instances[0].node, 0);
}

TEST(GltfAnimation, channels_without_a_node_and_of_other_scenes_are_left_out) {
  GltfBuilder made = animated();
  channel_of(made)["target"].erase("node");
  EXPECT_EQ(made.load().rig, nullptr);
  made = animated();
  made.root["nodes"].push_back(json::object());
  channel_of(made)["target"]["node"] = 1;
  EXPECT_EQ(made.load().rig, nullptr);
}

TEST(GltfAnimation, unknown_paths_and_weights_without_targets_are_a_warning) {
  GltfBuilder made = animated();
  channel_of(made)["target"] = {{"path", "pointer"},
                                {"extensions", {{"KHR_animation_pointer", {{"pointer", "/nodes/0/mesh"}}}}}};
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().rig, nullptr); }),
              HasSubstr("animation 0 channel 0: pointer \"/nodes/0/mesh\" is not supported; left out"));
  made = animated();
  channel_of(made)["target"]["path"] = "weights";
  EXPECT_THAT(warnings_of([&] { EXPECT_EQ(made.load().rig, nullptr); }),
              HasSubstr("animation 0 channel 0: node 0 has no morph targets; left out"));
}

TEST(GltfAnimation, sparse_values_and_values_without_a_view_are_read) {
  GltfBuilder made = animated();
  const int zeros = made.accessor(-1, "VEC3", f32, 2);
  made.root["accessors"][zeros]["sparse"] = {
      {"count", 1},
      {"indices",
       {{"bufferView", made.view(bytes_of(std::vector<uint16_t>{1}))}, {"componentType", int(u16)}}},
      {"values", {{"bufferView", made.view(bytes_of(std::vector<float>{0, 6, 0}))}}}};
  sampler_of(made)["output"] = zeros;
  Scene scene = made.load();
  set_time(scene, 0.5);
  EXPECT_EQ(scene.instances[0].world_from_object[3], glm::dvec4(0, 3, 0, 1));
}

TEST(GltfAnimation, two_channels_of_one_target_and_a_node_with_a_matrix_are_left_out) {
  GltfBuilder made = animated();
  animate(made, 0, "translation", {0}, "VEC3", {0, 0, 0});
  EXPECT_EQ(left_out(made),
            "made.gltf: animation 0 channel 1: an earlier channel animates the translation of node 0 too");
  made = animated();
  made.node()["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_EQ(left_out(made),
            "made.gltf: animation 0 channel 0: node 0 has a matrix; only translation, rotation and scale can "
            "be animated");
}

TEST(GltfAnimation, times_that_decrease_or_are_negative_are_left_out) {
  GltfBuilder made = animated();
  made.root["animations"][0]["name"] = "walk";
  set_times(made, {2, 1});
  EXPECT_EQ(left_out(made), "made.gltf: animation 0 \"walk\" sampler 0: input: time 1 is 1, before 2");
  set_times(made, {-1, 1});
  EXPECT_THAT(left_out(made), HasSubstr("input: time 0 is -1, before 0"));
  set_times(made, {0, std::numeric_limits<float>::infinity()});
  EXPECT_THAT(left_out(made), HasSubstr("sampler 0: input: element 1 is inf"));
}

TEST(GltfAnimation, numbers_of_keys_and_values_that_do_not_fit_are_left_out) {
  GltfBuilder made = animated();
  set_times(made, {0, 1, 2});
  EXPECT_THAT(left_out(made), HasSubstr("animation 0 sampler 0: output has 6 numbers for 3 keys of 3"));
  made = animated();
  sampler_of(made)["interpolation"] = "CUBICSPLINE";
  EXPECT_THAT(left_out(made), HasSubstr("output has 6 numbers for 2 keys of 9"));
  set_times(made, {0});
  EXPECT_THAT(left_out(made), HasSubstr("a cubic spline of one key; it needs two"));

  made = GltfBuilder::triangle();
  const int target = float_accessor(made, "VEC3", 3, {0, 0, 0, 0, 0, 2, 0, 0, 0});
  made.primitive()["targets"] = {{{"POSITION", target}}, {{"POSITION", target}}};
  animate(made, 0, "weights", {0, 1}, "SCALAR", {0, 1, 0});
  EXPECT_THAT(left_out(made), HasSubstr("output has 3 numbers for 2 keys of 2"));
}

TEST(GltfAnimation, types_that_do_not_fit_are_left_out) {
  GltfBuilder made = animated();
  sampler_of(made)["output"] = float_accessor(made, "VEC4", 4, {0, 0, 0, 1, 0, 0, 0, 1});
  EXPECT_THAT(left_out(made), HasSubstr("animation 0 sampler 0: output: is not of type VEC3"));
  made = animated();
  sampler_of(made)["output"] =
      made.accessor(made.view(bytes_of(std::vector<int16_t>(8))), "VEC3", i16, 2, true);
  made.root["bufferViews"].back()["byteStride"] = 8;
  EXPECT_THAT(left_out(made), HasSubstr("output: componentType is 5122; it must be float"));
  made = animated();
  sampler_of(made)["input"] = made.accessor(made.view(bytes_of(std::vector<uint8_t>{0, 1})), "SCALAR", u8, 2);
  EXPECT_THAT(left_out(made), HasSubstr("input: componentType is 5121; it must be float"));
  made = animated();
  sampler_of(made)["interpolation"] = "BEZIER";
  EXPECT_THAT(left_out(made), HasSubstr("animation 0 sampler 0: interpolation is \"BEZIER\""));
}

TEST(GltfAnimation, a_rotation_of_no_length_is_left_out) {
  GltfBuilder made = GltfBuilder::triangle();
  animate(made, 0, "rotation", {0, 1}, "VEC4", {0, 0, 0, 1, 0, 0, 0, 0});
  EXPECT_THAT(left_out(made),
              HasSubstr("animation 0 sampler 0: output: rotation 1 is a quaternion of length 0"));
}

TEST(GltfAnimation, broken_json_and_indices_out_of_range_are_named) {
  const std::tuple<const char*, json, const char*> cases[] = {
      {"/animations/0/channels", 3, "animations[0].channels is not an array"},
      {"/animations/0/channels/0", 3, "animations[0].channels[0] is not an object"},
      {"/animations/0/channels/0/target", 3, "animations[0].channels[0].target is not an object"},
      {"/animations/0/channels/0/target/path", 3, "animations[0].channels[0].target.path is not a string"},
      {"/animations/0/channels/0/target/node", 7, "animation 0 channel 0: target node is 7, but there are 1"},
      {"/animations/0/channels/0/sampler", 7, "animation 0 channel 0: sampler is 7, but there are 1"},
      {"/animations/0/samplers/0/input", 70, "animation 0 sampler 0: input: accessor is 70, but there are 3"},
      {"/animations/0/samplers/0/output", -1, "animations[0].samplers[0].output is -1: not an index"},
      {"/animations/0/samplers/0/output", 0.5, "animations[0].samplers[0].output is 0.5: not an index"},
      {"/animations/0/samplers/0/interpolation", 3,
       "animations[0].samplers[0].interpolation is not a string"},
  };
  for (const auto& [pointer, value, message] : cases) {
    GltfBuilder made = animated();
    made.root[json::json_pointer(pointer)] = value;
    EXPECT_EQ(left_out(made), std::string("made.gltf: ") + message);
  }
  GltfBuilder made = animated();
  sampler_of(made).erase("input");
  EXPECT_EQ(left_out(made), "made.gltf: animation 0 sampler 0: has no input");
  channel_of(made).erase("sampler");
  EXPECT_EQ(left_out(made), "made.gltf: animation 0 channel 0: has no sampler");
}

TEST(GltfAnimation, a_broken_one_leaves_the_others_their_numbers_and_their_motion) {
  GltfBuilder made = animated();
  made.root["nodes"].push_back({{"mesh", 0}});
  made.root["scenes"][0]["nodes"] = {0, 1};
  animate(made, 1, "translation", {0, 1}, "VEC3", {0, 0, 0, 0, 2, 0}, "LINEAR", 1);
  animate(made, 0, "scale", {0, 1}, "VEC3", {1, 1, 1, 2, 2, 2}, "LINEAR", 2);
  made.root["animations"][0]["name"] = "walk";
  // The first key before zero, and a number for a name, as old exporters wrote it.
  set_times(made, {-1, 1});
  made.root["animations"][2]["samplers"][0]["interpolation"] = 0;
  Scene scene;
  const std::string warning = warnings_of([&] { scene = made.load(); });
  EXPECT_THAT(warning,
              HasSubstr("animation 0 \"walk\" sampler 0: input: time 0 is -1, before 0; this animation "
                        "is left out, and 1 more\n"));
  ASSERT_EQ(animation_count(scene), 3);
  EXPECT_EQ(scene.rig->animations[0].name, "walk");
  EXPECT_THAT(scene.rig->animations[0].channels, IsEmpty());
  EXPECT_EQ(scene.instances[0].node, -1) << "its animation is left out: it is static";
  EXPECT_EQ(set_time(scene, 0.5).instances, std::vector<int>{1});
  EXPECT_EQ(scene.instances[1].world_from_object[3], glm::dvec4(0, 1, 0, 1));
}

TEST(GltfAnimation, broken_geometry_is_refused_with_and_without_a_broken_animation) {
  GltfBuilder made = animated();
  made.primitive()["attributes"]["NORMAL"] = 99;
  EXPECT_EQ(made.refusal(), "made.gltf: mesh 0 primitive 0: NORMAL is 99, but there are 3");
  set_times(made, {-1, 1});
  EXPECT_EQ(made.refusal(), "made.gltf: mesh 0 primitive 0: NORMAL is 99, but there are 4");
}

TEST(GltfAnimation, the_limit_of_values_holds) {
  GltfBuilder made = animated();
  EXPECT_EQ(animation_count(made.load({.max_animation_values = 8})), 1);
  EXPECT_THAT(left_out(made, {.max_animation_values = 7}),
              HasSubstr("sampler 0: output: with it, animations have more than 7 numbers"));
  const int huge = made.accessor(-1, "SCALAR", f32, 2'000'000'000);
  sampler_of(made)["input"] = huge;
  EXPECT_THAT(left_out(made), HasSubstr("input: with it, animations have more than 50000000 numbers"));
}

TEST(GltfAnimation, displaced_vertices_count_as_vertices) {
  GltfBuilder made = GltfBuilder::triangle();
  made.attribute("NORMAL", std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3", f32, 3);
  const int target = float_accessor(made, "VEC3", 3, {0, 0, 0, 0, 0, 2, 0, 0, 0});
  made.primitive()["targets"] = {{{"POSITION", target}}, {{"POSITION", target}}};
  animate(made, 0, "weights", {0}, "SCALAR", {0, 1});
  EXPECT_EQ(made.load({.max_vertices = 9}).meshes.size(), 1u);
  EXPECT_THAT(made.refusal({.max_vertices = 8}),
              HasSubstr("target 1 POSITION: 3 displaced vertices more pass the limit of 8 vertices"));
}

}  // namespace
}  // namespace lightgrid
