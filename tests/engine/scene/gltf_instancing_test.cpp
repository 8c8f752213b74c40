// EXT_mesh_gpu_instancing: places of instances, faults, and instances of a node that moves.
#include "scene/animation.h"
#include "support/gltf_builder.h"
#include "support/near.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using Floats = std::vector<float>;

struct InstancedTriangle : GltfBuilder {
  InstancedTriangle() : GltfBuilder(triangle()) {
    root["extensionsUsed"] = root["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = json::object();
  }
  json& attributes() { return node()["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]; }

  template <typename T>
  void set(const char* name, const std::vector<T>& values, const char* type, ComponentType component,
           size_t count, bool normalized = false) {
    attributes()[name] = accessor(view(bytes_of(values)), type, component, count, normalized);
  }
};

TEST(GltfInstancing, the_nodes_transform_applies_after_the_instances_own) {
  InstancedTriangle made;
  made.node()["scale"] = {10, 10, 10};
  made.node()["name"] = "tree";
  made.set("TRANSLATION", Floats{1, 2, 3, 4, 5, 6}, "VEC3", f32, 2);
  made.set("ROTATION", Floats{0, 0, 0, 1, 0, 0, 1, 1}, "VEC4", f32, 2);
  made.set("SCALE", Floats{1, 1, 1, 2, -3, 4}, "VEC3", f32, 2);
  made.set("_ID", std::vector<uint16_t>{7, 8}, "SCALAR", u16, 2);
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), IsEmpty());
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_EQ(scene.instances[1].name, "tree");
  EXPECT_EQ(scene.instances[1].node, -1);
  expect_near(at(scene.instances[0].world_from_object, {1, 1, 1}), {20, 30, 40});
  expect_near(at(scene.instances[1].world_from_object, {1, 0, 0}), {40, 70, 60}, 1e-6);
  expect_near(at(scene.instances[1].world_from_object, {0, 1, 1}), {70, 50, 100}, 1e-6);
}

TEST(GltfInstancing, primitives_have_all_instances_and_children_none) {
  InstancedTriangle made;
  made.root["meshes"][0]["primitives"].push_back(made.primitive());
  made.node()["children"] = {1};
  made.root["nodes"].push_back({{"mesh", 0}});
  made.set("TRANSLATION", Floats(9), "VEC3", f32, 3);
  EXPECT_EQ(made.load().instances.size(), 8u);
}

TEST(GltfInstancing, a_node_without_a_mesh_has_no_instances) {
  InstancedTriangle made;
  made.set("TRANSLATION", Floats(9), "VEC3", f32, 3);
  made.node().erase("mesh");
  EXPECT_TRUE(made.load().instances.empty());
}

TEST(GltfInstancing, attributes_alone_give_the_count) {
  InstancedTriangle made;
  made.set("_ID", Bytes{1, 2, 3}, "SCALAR", u8, 3);
  EXPECT_EQ(made.load().instances.size(), 3u);
}

TEST(GltfInstancing, instances_scaled_to_a_line_are_left_out_with_one_warning) {
  InstancedTriangle made;
  made.set("SCALE", Floats{1, 1, 0, 0, 1, 0, 1, 0, 0}, "VEC3", f32, 3);
  const std::string warning = warnings_of([&] { EXPECT_EQ(made.load().instances.size(), 1u); });
  EXPECT_THAT(warning, HasSubstr("node 0 instance 1: is scaled to a line or a point and left out"));
  EXPECT_EQ(std::ranges::count(warning, '\n'), 1);
}

TEST(GltfInstancing, faults_are_refused) {
  const auto refusal = [](const auto& change, const GltfLimits& limits = {}) {
    InstancedTriangle made;
    made.set("TRANSLATION", Floats(6), "VEC3", f32, 2);
    change(made);
    return made.refusal(limits);
  };
  const std::string place = "made.gltf: node 0: EXT_mesh_gpu_instancing";
  EXPECT_EQ(refusal([](auto& made) { made.set("SCALE", Floats(9), "VEC3", f32, 3); }),
            place + ": SCALE has 3 elements, but TRANSLATION has 2");
  EXPECT_EQ(refusal([](auto& made) { made.set("_ID", Bytes{1}, "SCALAR", u8, 1); }),
            place + ": TRANSLATION has 2 elements, but _ID has 1");
  EXPECT_EQ(refusal([](auto& made) { made.set("TRANSLATION", Floats(8), "VEC4", f32, 2); }),
            place + ": TRANSLATION is not of type VEC3");
  EXPECT_EQ(refusal([](auto& made) { made.set("ROTATION", Floats(6), "VEC3", f32, 2); }),
            place + ": ROTATION is not of type VEC4");
  EXPECT_EQ(refusal([](auto& made) { made.set("SCALE", Bytes(6), "VEC3", u8, 2); }),
            place + ": SCALE has componentType 5121; it must be float");
  EXPECT_EQ(
      refusal([](auto& made) { made.set("TRANSLATION", std::vector<int16_t>(6), "VEC3", i16, 2, true); }),
      place + ": TRANSLATION has componentType 5122, normalized; it must be float");
  EXPECT_EQ(refusal([](auto& made) { made.set("ROTATION", std::vector<int16_t>(8), "VEC4", i16, 2); }),
            place + ": ROTATION has componentType 5122; it must be float, or a normalized byte or short");
  EXPECT_EQ(refusal([](auto& made) {
              made.set("ROTATION", Floats{0, 0, 0, 1, 0, 0, 0, 0}, "VEC4", f32, 2);
            }),
            place + ": ROTATION: element 1 is a quaternion of length 0");
  EXPECT_EQ(refusal([](auto& made) {
              made.set("TRANSLATION", Floats{0, NAN, 0, 0, 0, 0}, "VEC3", f32, 2);
            }),
            place + ": TRANSLATION: element 0 is nan");
  EXPECT_EQ(refusal([](auto& made) { made.attributes() = json::object(); }), place + ": has no attributes");
  EXPECT_EQ(
      refusal([](auto& made) { made.node()["extensions"]["EXT_mesh_gpu_instancing"] = json::object(); }),
      place + ": has no attributes");
  EXPECT_EQ(refusal([](auto& made) { made.attributes()["SCALE"] = 9; }),
            "made.gltf: node 0: SCALE is 9, but there are 2");
  EXPECT_EQ(refusal([](auto& made) { made.attributes()["SCALE"] = json::array({1}); }),
            "made.gltf: node 0: SCALE is -1, but there are 2");
  EXPECT_THAT(refusal([](auto& made) { made.attributes()["SCALE"] = -1; }), HasSubstr("not an index"));
  EXPECT_THAT(refusal([](auto& made) { made.root["accessors"][1]["count"] = 3; }), HasSubstr("do not fit"));
  EXPECT_EQ(refusal([](auto&) {}, {.max_instances = 1}), place + ": has 2 instances, more than 1");
  EXPECT_EQ(refusal(
                [](auto& made) {
                  made.root["nodes"].push_back(made.node());
                  made.root["scenes"][0]["nodes"] = {0, 1};
                },
                {.max_instances = 3}),
            "made.gltf: node 1 instance 1: more than 3 instances");
  EXPECT_EQ(refusal([](auto& made) {
              made.root["skins"] = {{{"joints", {0}}}};
              made.node()["skin"] = 0;
            }),
            place + ": the node has a skin; skinned meshes have no instances");
  EXPECT_EQ(refusal([](auto& made) {
              made.set("SCALE", Floats{1, 1, 1, 1e30f, 1, 1}, "VEC3", f32, 2);
              made.node()["scale"] = {1e300, 1, 1};
            }),
            "made.gltf: node 0 instance 1: its world matrix is not finite");
}

TEST(GltfInstancing, instances_follow_a_node_that_moves) {
  InstancedTriangle made;
  made.set("TRANSLATION", Floats{0, 0, 0, 0, 5, 0}, "VEC3", f32, 2);
  const int times = made.accessor(made.view(bytes_of(Floats{0, 1})), "SCALAR", f32, 2);
  const int values = made.accessor(made.view(bytes_of(Floats{0, 0, 0, 8, 0, 0})), "VEC3", f32, 2);
  made.root["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
       {"samplers", {{{"input", times}, {"output", values}}}}}};
  Scene scene = made.load();
  ASSERT_EQ(scene.instances.size(), 2u);
  EXPECT_EQ(set_time(scene, 0.5).instances.size(), 2u);
  expect_near(at(scene.instances[0].world_from_object, {0, 0, 0}), {4, 0, 0});
  expect_near(at(scene.instances[1].world_from_object, {0, 0, 0}), {4, 5, 0});
}

}  // namespace
}  // namespace lightgrid
