// KHR_node_visibility, and KHR_animation_pointer to visibility, lights and nodes.
#include "support/gltf_pointers.h"

#include "scene/animation.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

const json hidden = {{"KHR_node_visibility", {{"visible", false}}}};

// Node 0 holds node 1, which has a triangle and node 2, which has a spot light.
GltfBuilder nested() {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_node_visibility", "KHR_lights_punctual", "KHR_animation_pointer"};
  made.root["extensionsRequired"] = made.root["extensionsUsed"];
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"}, {"intensity", 4}, {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}}};
  made.root["nodes"] = {{{"children", {1}}},
                        {{"children", {2}}, {"mesh", 0}, {"name", "triangle"}},
                        {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  return made;
}

void hide(GltfBuilder& made, int node) { made.root["nodes"][node]["extensions"].update(hidden); }

const std::string visible_of_0 = visible_of(0);
const std::string light_0 = "/extensions/KHR_lights_punctual/lights/0/";

// The size of instance 0: a hidden one is a point.
double size_of(const Scene& scene) { return glm::length(scene.instances.at(0).world_from_object[0]); }

TEST(GltfVisibility, hidden_nodes_hide_their_meshes_lights_and_descendants) {
  const auto expect = [](int node, size_t instances, size_t lights) {
    GltfBuilder made = nested();
    if (node >= 0) hide(made, node);
    Scene scene;
    EXPECT_THAT(warnings_of([&] { scene = made.load(); }), IsEmpty());
    EXPECT_EQ(scene.instances.size(), instances) << node;
    EXPECT_EQ(scene.lights.size(), lights) << node;
  };
  expect(-1, 1, 1);
  expect(0, 0, 0);
  expect(1, 0, 0);
  expect(2, 1, 0);
  GltfBuilder made = nested();
  hide(made, 0);
  made.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true;
  EXPECT_EQ(made.load().instances.size(), 0u) << "a child cannot be shown under a hidden parent";
  made.root["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = 1;
  EXPECT_THAT(made.refusal(), HasSubstr("node 1 \"triangle\": KHR_node_visibility.visible is neither"));
}

TEST(GltfVisibility, follows_an_animation_there_and_back) {
  GltfBuilder made = nested();
  hide(made, 0);
  animate(made, visible_of_0, std::vector<uint8_t>{1, 0, 1}, "SCALAR", u8);
  Scene scene = made.load();
  ASSERT_EQ(scene.instances.size(), 1u);
  ASSERT_EQ(scene.lights.size(), 1u);
  const auto expect = [&](bool is_shown, std::optional<double> seconds) {
    EXPECT_EQ(size_of(scene) == 1, is_shown) << seconds.value_or(-1);
    EXPECT_EQ(scene.lights[0].intensity, is_shown ? 4 : 0) << seconds.value_or(-1);
    EXPECT_EQ(scene.lights[0].radius_m, is_shown ? std::numeric_limits<float>::infinity() : 0);
    Scene fresh = made.load();
    set_time(fresh, seconds);
    EXPECT_EQ(fresh.instances[0].world_from_object, scene.instances[0].world_from_object);
    EXPECT_EQ(fresh.lights, scene.lights);
  };
  expect(false, {});
  for (const auto& [seconds, is_shown] : {std::pair(0.0, true), {0.9, true}, {1.5, false}, {2.0, true}}) {
    const SceneChanges changes = set_time(scene, seconds);
    EXPECT_EQ(changes.instances.size(), seconds == 0.9 ? 0u : 1u) << seconds;
    EXPECT_EQ(changes.lights.size(), seconds == 0.9 ? 0u : 1u) << seconds;
    expect(is_shown, seconds);
  }
  hide(made, 1);
  EXPECT_EQ(made.load().instances.size(), 0u) << "node 1 is hidden at all times";
}

TEST(GltfVisibility, what_is_hidden_at_a_time_is_in_no_total_and_no_box) {
  GltfBuilder made = nested();
  made.root["nodes"].push_back({{"mesh", 0}, {"translation", {50, 0, 0}}});
  made.root["scenes"][0]["nodes"].push_back(3);
  animate(made, visible_of(3), std::vector<uint8_t>{1, 0, 1}, "SCALAR", u8);
  animate(made, visible_of(2), std::vector<uint8_t>{0, 1, 1}, "SCALAR", u8);
  Scene scene = made.load();
  const auto expect = [&](size_t instances, size_t lights, double right_m) {
    EXPECT_EQ(shown_counts(scene).instances, instances);
    EXPECT_EQ(shown_counts(scene).lights, lights);
    EXPECT_EQ(world_box(scene).max.x, right_m);
  };
  expect(2, 1, 51);
  set_time(scene, 0);
  expect(2, 0, 51);
  set_time(scene, 1);
  expect(1, 1, 1);
  set_time(scene, 2);
  expect(2, 1, 51);
}

// A light that replaces the file's has no node, and so stays as it is.
TEST(GltfVisibility, a_light_that_the_caller_replaced_is_neither_hidden_nor_animated) {
  GltfBuilder made = nested();
  animate(made, visible_of_0, std::vector<uint8_t>{1, 0, 1}, "SCALAR", u8);
  animate(made, light_0 + "intensity", std::vector<float>{1, 8, 2}, "SCALAR", f32);
  Scene scene = made.load();
  Light own = scene.lights.at(0);
  own.intensity = 7;
  own.radius_m = 3;
  own.node = -1;
  scene.lights = {own};
  for (const double seconds : {0.0, 1.0, 2.0}) {
    EXPECT_TRUE(set_time(scene, seconds).lights.empty());
    EXPECT_EQ(scene.lights.at(0), own);
  }
}

TEST(GltfVisibility, a_skinned_mesh_is_hidden_with_its_node) {
  GltfBuilder made = nested();
  made.attribute("JOINTS_0", std::vector<uint8_t>(12), "VEC4", u8, 3);
  made.attribute("WEIGHTS_0", std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4", f32, 3);
  made.root["skins"] = {{{"joints", {2}}}};
  made.root["nodes"][1]["skin"] = 0;
  animate(made, visible_of_0, std::vector<uint8_t>{1, 0, 1}, "SCALAR", u8);
  Scene scene = made.load();
  EXPECT_EQ(size_of(scene), 1);
  set_time(scene, 1);
  EXPECT_LT(size_of(scene), 1e-9);
  set_time(scene, 2);
  EXPECT_EQ(size_of(scene), 1);
}

TEST(GltfVisibility, properties_of_lights_are_animated) {
  GltfBuilder made = nested();
  animate(made, light_0 + "intensity", std::vector<float>{1, 8, -2}, "SCALAR", f32, "LINEAR");
  animate(made, light_0 + "color", std::vector<float>{1, 1, 1, 0.5f, 0, 1, 0, 0, 0}, "VEC3", f32, "LINEAR");
  animate(made, light_0 + "range", std::vector<float>{2, 4, 0}, "SCALAR", f32);
  animate(made, light_0 + "spot/innerConeAngle", std::vector<float>{0.125f, 0.25f, 1}, "SCALAR", f32);
  animate(made, light_0 + "spot/outerConeAngle", std::vector<float>{0.5f, 0.75f, 0.75f}, "SCALAR", f32);
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), IsEmpty());
  const Light rest = scene.lights.at(0);
  EXPECT_EQ(rest.intensity, 4);
  set_time(scene, 0.5);
  EXPECT_EQ(scene.lights[0].intensity, 4.5f);
  EXPECT_EQ(scene.lights[0].color, glm::vec3(0.75f, 0.5f, 1));
  EXPECT_EQ(scene.lights[0].radius_m, 2);
  EXPECT_EQ(scene.lights[0].inner_cone_rad, 0.125f);
  set_time(scene, 1);
  EXPECT_EQ(scene.lights[0].intensity, 8);
  EXPECT_EQ(scene.lights[0].outer_cone_rad, 0.75f);
  set_time(scene, 2);
  EXPECT_EQ(scene.lights[0].intensity, 0) << "a negative one counts as 0";
  EXPECT_EQ(scene.lights[0].radius_m, std::numeric_limits<float>::infinity()) << "0: no range";
  EXPECT_EQ(scene.lights[0].inner_cone_rad, 0.75f) << "at most the outer one";
  set_time(scene, {});
  EXPECT_EQ(scene.lights[0], rest);
}

TEST(GltfVisibility, cubic_splines_of_lights_have_three_values_for_each_key) {
  GltfBuilder made = nested();
  animate(made, light_0 + "intensity", std::vector<float>{0, 1, 0, 0, 3, 0, 0, 3, 0}, "SCALAR", f32,
          "CUBICSPLINE");
  Scene scene = made.load();
  set_time(scene, 0.5);
  EXPECT_EQ(scene.lights.at(0).intensity, 2);
}

TEST(GltfVisibility, pointers_to_nodes_move_them_and_others_are_named) {
  GltfBuilder made = nested();
  animate(made, "/nodes/1/translation", std::vector<float>{0, 0, 0, 2, 0, 0, 4, 0, 0}, "VEC3", f32, "LINEAR");
  animate(made, "/materials/0/alphaCutoff", std::vector<float>{0, 1, 0}, "SCALAR", f32);
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }),
              HasSubstr("pointer \"/materials/0/alphaCutoff\" is not supported; left out"));
  set_time(scene, 1);
  EXPECT_EQ(scene.instances.at(0).world_from_object[3].x, 2);
}

TEST(GltfVisibility, meshes_scaled_to_a_plane_are_read_and_those_scaled_to_a_line_are_not) {
  GltfBuilder made = GltfBuilder::triangle();
  made.node()["scale"] = {1, 1, 0};
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), IsEmpty());
  EXPECT_EQ(scene.instances.at(0).world_from_object[1].y, 1);
  made.node()["scale"] = {1, 0, 0};
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), HasSubstr("scaled to a line or a point"));
  EXPECT_EQ(scene.instances.size(), 0u);
}

}  // namespace
}  // namespace lightgrid
