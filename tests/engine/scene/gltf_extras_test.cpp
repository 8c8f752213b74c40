// extras.lightgrid of scenes, nodes and lights, the old places of its fields, and other programs' extras.
#include "scene/light_groups.h"
#include "support/gltf_builder.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

json own(const json& fields) { return {{"lightgrid", fields}}; }

// A triangle and a point light, on one node.
GltfBuilder lit_triangle(const json& extras_of_light, const json& extras_of_node) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_lights_punctual"};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"extras", extras_of_light}}};
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 0;
  made.node()["extras"] = extras_of_node;
  return made;
}

GltfBuilder with_scene_extras(const json& extras) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["scenes"][0]["extras"] = extras;
  return made;
}

TEST(GltfExtras, the_scene_that_is_shown_has_samples_and_radiances) {
  GltfBuilder made = GltfBuilder::triangle();
  EXPECT_EQ(made.load().samples, 1);
  made.root["scenes"] = {{{"nodes", {0}}, {"extras", own({{"samples", 8}, {"ambient", {0.25, 0.5, 1}}})}},
                         {{"nodes", {0}}, {"extras", own({{"samples", 4.0}, {"background", {0, 2, 0}}})}},
                         {{"nodes", {0}}}};
  EXPECT_EQ(made.load().samples, 8);
  EXPECT_EQ(made.load().ambient, glm::vec3(0.25f, 0.5f, 1));
  EXPECT_EQ(made.load({}, 1).samples, 4);
  EXPECT_EQ(made.load({}, 1).background, glm::vec3(0, 2, 0));
  EXPECT_EQ(made.load({}, 2).samples, 1);
}

TEST(GltfExtras, a_node_overrides_its_light) {
  const auto light = [](const json& of_light, const json& of_node) {
    return lit_triangle(own(of_light), own(of_node)).load().lights.at(0);
  };
  const json none = json::object(), yes = {{"casts_shadow", true}}, no = {{"casts_shadow", false}};
  EXPECT_FALSE(light(none, none).casts_shadow);
  EXPECT_TRUE(light(yes, none).casts_shadow);
  EXPECT_TRUE(light(none, yes).casts_shadow);
  EXPECT_TRUE(light(no, yes).casts_shadow);
  EXPECT_FALSE(light(yes, no).casts_shadow);
  EXPECT_TRUE(light(none, {{"casts_shadow", 1}}).casts_shadow) << "as Blender writes custom properties";
  EXPECT_FALSE(light(none, {{"casts_shadow", 0.0}}).casts_shadow);
  const json small = {{"source_radius", 0.25}}, point = {{"source_radius", 0}};
  EXPECT_LT(light(none, none).source_m, 0) << "that of the setting shadow-source";
  EXPECT_EQ(light(small, none).source_m, 0.25f);
  EXPECT_EQ(light(none, small).source_m, 0.25f);
  EXPECT_EQ(light(small, point).source_m, 0);
  EXPECT_FALSE(lit_triangle({}, own(no)).load().instances.at(0).casts_shadow);
}

TEST(GltfExtras, unknown_keys_and_wrong_values_are_refused_by_name) {
  const auto of_scene = [](const json& fields) { return with_scene_extras(own(fields)).refusal(); };
  for (const json& wrong : {json(3), json(0), json(-4), json(4.5), json(16), json("4"), json(true), json()})
    EXPECT_EQ(of_scene({{"samples", wrong}}), "made.gltf: scene 0: extras.lightgrid.samples is " +
                                                  wrong.dump() + "; it must be 1, 2, 4 or 8");
  for (const json& wrong :
       std::initializer_list<json>{{1, 2}, {1, 2, -1}, {1, 2, "3"}, 0.5, {1, 2, 1e300}, "#112233"})
    EXPECT_THAT(of_scene({{"ambient", wrong}}), HasSubstr("it must be three finite numbers of 0 or more"));
  EXPECT_THAT(of_scene({{"sample", 4}}),
              HasSubstr("scene 0: extras.lightgrid.sample: unknown field; did you mean samples?; fields are "
                        "samples, ambient, background"));
  EXPECT_THAT(lit_triangle({}, own({{"casts_shadows", true}})).refusal(),
              HasSubstr("node 0: extras.lightgrid.casts_shadows: unknown field; did you mean casts_shadow?"));
  EXPECT_THAT(
      lit_triangle(own({{"casts_shadow", "On"}}), {}).refusal(),
      HasSubstr("light 0: extras.lightgrid.casts_shadow is \"On\"; it must be true, false or a number"));
  EXPECT_THAT(lit_triangle(own({{"source_radius", -1}}), {}).refusal(), HasSubstr("source_radius is -1"));
  EXPECT_THAT(lit_triangle(own({{"light_groups", {40}}}), {}).refusal(), HasSubstr("light_groups is [40]"));
  EXPECT_THAT(lit_triangle(own(3), {}).refusal(), HasSubstr("light 0: extras.lightgrid is not an object"));
}

TEST(GltfExtras, the_old_places_are_read_with_a_warning) {
  Scene scene;
  const json of_scene = {{"samples", 2}, {"ambient", {1, 2, 3}}};
  EXPECT_THAT(warnings_of([&] { scene = with_scene_extras(of_scene).load(); }),
              HasSubstr("scene 0: extras.samples is read, but its place is now extras.lightgrid.samples"));
  EXPECT_EQ(scene.samples, 2);
  EXPECT_EQ(scene.ambient, glm::vec3(1, 2, 3));
  const json of_light = {{"casts_shadow", 1}, {"source_radius", 0.5}, {"light_groups", {2}}};
  EXPECT_THAT(warnings_of([&] { scene = lit_triangle(of_light, {}).load(); }), HasSubstr("light 0: extras."));
  EXPECT_TRUE(scene.lights.at(0).casts_shadow);
  EXPECT_EQ(scene.lights.at(0).source_m, 0.5f);
  EXPECT_EQ(groups_of(scene.lights.at(0)), 1u << 2);
  json both = own({{"casts_shadow", false}});
  both["casts_shadow"] = true;
  EXPECT_FALSE(lit_triangle(both, {}).load().lights.at(0).casts_shadow) << "the new place wins";
}

// Blender's custom properties, userData of three.js.
TEST(GltfExtras, other_programs_extras_are_ignored_silently) {
  Scene scene;
  const json of_scene = {{"samples", 128}, {"background", "#112233"}, {"ambient", {{"r", 1}}}};
  EXPECT_THAT(warnings_of([&] { scene = with_scene_extras(of_scene).load(); }), IsEmpty());
  EXPECT_EQ(scene.samples, 1);
  EXPECT_EQ(scene.background, glm::vec3(0));
  const json of_light = {{"casts_shadow", "On"},
                         {"source_radius", -1},
                         {"light_groups", {{"a", 1}}},
                         {"light_include", {{{"b", 1}}}},
                         {"light_exclude", 2.5}};
  EXPECT_THAT(warnings_of([&] { scene = lit_triangle(of_light, of_light).load(); }), IsEmpty());
  EXPECT_FALSE(scene.lights.at(0).casts_shadow);
  EXPECT_LT(scene.lights.at(0).source_m, 0);
  EXPECT_EQ(groups_of(scene.lights.at(0)), all_groups);
  EXPECT_TRUE(scene.instances.at(0).casts_shadow);
  for (const json& extras : {json("text"), json(3), json({1, 2}), json()}) {
    EXPECT_THAT(warnings_of([&] { with_scene_extras(extras).load(); }), IsEmpty());
    EXPECT_THAT(warnings_of([&] { lit_triangle(extras, extras).load(); }), IsEmpty());
  }
}

TEST(GltfExtras, owners_that_have_none_are_named) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["meshes"][0]["extras"] = own({{"casts_shadow", false}});
  EXPECT_THAT(warnings_of([&] { made.load(); }), HasSubstr("meshes[0].extras.lightgrid is not read"));
}

}  // namespace
}  // namespace lightgrid
