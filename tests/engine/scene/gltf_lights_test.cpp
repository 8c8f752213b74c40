// KHR_lights_punctual and cameras.
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/area_lights.h"
#include "scene/light_groups.h"
#include "support/gltf_builder.h"
#include "support/near.h"

namespace lightgrid {
namespace {

using nlohmann::json;
using testing::HasSubstr;

GltfBuilder with_camera(const json& camera) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["cameras"] = {camera};
  made.node()["camera"] = 0;
  return made;
}

TEST(GltfCameras, a_perspective_camera_is_rigid_whatever_its_node_is_scaled_by) {
  GltfBuilder made = with_camera(
      {{"type", "perspective"}, {"name", "main"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.25}}}});
  made.node()["translation"] = {1, 2, 3};
  made.node()["rotation"] = {0, root_half, 0, root_half};  // a quarter turn about y: -z to -x
  made.node()["scale"] = {2, 5, -3};
  const Camera camera = made.load().cameras.at(0);
  EXPECT_EQ(camera.name, "main");
  EXPECT_FALSE(camera.orthographic);
  EXPECT_EQ(camera.fov_y_rad, 0.5);
  EXPECT_EQ(camera.aspect, 0);
  EXPECT_EQ(camera.near_m, 0.25);
  EXPECT_TRUE(std::isinf(camera.far_m));
  expect_near(at(camera.world_from_view, {0, 0, 0}), {1, 2, 3});
  EXPECT_NEAR(glm::determinant(camera.world_from_view), 1, 1e-12);
}

TEST(GltfCameras, aspect_far_plane_and_orthographic_sizes_are_read) {
  const Camera perspective =
      with_camera({{"type", "perspective"},
                   {"perspective", {{"yfov", 1}, {"znear", 1}, {"zfar", 9}, {"aspectRatio", 1.5}}}})
          .load()
          .cameras.at(0);
  EXPECT_EQ(perspective.aspect, 1.5);
  EXPECT_EQ(perspective.far_m, 9);
  const Camera flat = with_camera({{"type", "orthographic"},
                                   {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 50}}}})
                          .load()
                          .cameras.at(0);
  EXPECT_TRUE(flat.orthographic);
  EXPECT_EQ(flat.half_width_m, 4);
  EXPECT_EQ(flat.half_height_m, 3);
  EXPECT_EQ(flat.near_m, 0);
  EXPECT_EQ(flat.far_m, 50);
}

// The warning with which the file's one camera is left out; its mesh is drawn.
std::string camera_warning(const GltfBuilder& made) {
  Scene scene;
  const std::string warning = warnings_of([&] { scene = made.load(); });
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_EQ(scene.meshes.size(), 1u);
  EXPECT_THAT(warning, HasSubstr("; this camera is left out\n"));
  return warning;
}

TEST(GltfCameras, impossible_cameras_are_left_out_with_a_warning) {
  const auto perspective = [](double yfov, double znear, double zfar) {
    return camera_warning(with_camera(
        {{"type", "perspective"}, {"perspective", {{"yfov", yfov}, {"znear", znear}, {"zfar", zfar}}}}));
  };
  EXPECT_THAT(perspective(0, 1, 2), HasSubstr("made.gltf: camera 0: yfov is 0"));
  EXPECT_THAT(perspective(3.2, 1, 2), HasSubstr("camera 0: yfov is 3.2"));
  EXPECT_THAT(perspective(1, 0, 2), HasSubstr("camera 0: znear is 0"));
  EXPECT_THAT(perspective(1, 2, 1), HasSubstr("camera 0: zfar is 1, not beyond znear 2"));
  EXPECT_THAT(
      camera_warning(with_camera({{"type", "orthographic"},
                                  {"orthographic", {{"xmag", 0}, {"ymag", 3}, {"znear", 0}, {"zfar", 5}}}})),
      HasSubstr("camera 0: xmag is 0"));
}

TEST(GltfCameras, one_left_out_leaves_the_others_and_the_number_is_told) {
  GltfBuilder made = with_camera({{"type", "perspective"}, {"perspective", {{"yfov", 0}, {"znear", 1}}}});
  made.root["cameras"].push_back(
      {{"type", "perspective"}, {"name", "good"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
  made.root["nodes"].push_back({{"camera", 1}});
  made.root["nodes"].push_back({{"camera", 0}});
  made.root["scenes"][0]["nodes"] = {0, 1, 2};
  Scene scene;
  const std::string warning = warnings_of([&] { scene = made.load(); });
  EXPECT_THAT(warning, HasSubstr("camera 0: yfov is 0; this camera is left out, and 1 more\n"));
  ASSERT_EQ(scene.cameras.size(), 1u);
  EXPECT_EQ(scene.cameras[0].name, "good");
}

GltfBuilder with_light(const json& light) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"KHR_lights_punctual"};
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {light};
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 0;
  return made;
}

TEST(GltfLights, a_spot_without_its_object_has_the_default_cone) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 0;
  const Light light = made.load().lights.at(0);
  EXPECT_EQ(light.type, LightType::spot);
  EXPECT_EQ(light.inner_cone_rad, 0);
  EXPECT_EQ(light.outer_cone_rad, float(glm::pi<double>() / 4));
}

TEST(GltfLights, a_light_looks_along_its_nodes_negative_z_and_keeps_its_range_under_scale) {
  GltfBuilder made = with_light({{"type", "spot"},
                                 {"color", {0.25, 0.5, 1}},
                                 {"intensity", 12.5},
                                 {"range", 8},
                                 {"name", "lamp"},
                                 {"spot", {{"innerConeAngle", 0.25}, {"outerConeAngle", 0.5}}}});
  made.node()["translation"] = {1, 2, 3};
  made.node()["rotation"] = {0, root_half, 0, root_half};
  made.node()["scale"] = {3, 3, 3};
  const Light light = made.load().lights.at(0);
  EXPECT_EQ(light.name, "lamp");
  EXPECT_EQ(light.type, LightType::spot);
  EXPECT_EQ(light.color, glm::vec3(0.25f, 0.5f, 1));
  EXPECT_EQ(light.intensity, 12.5f);
  EXPECT_EQ(light.radius_m, 8);
  EXPECT_EQ(light.inner_cone_rad, 0.25f);
  EXPECT_EQ(light.outer_cone_rad, 0.5f);
  expect_near(light.position, {1, 2, 3});
  EXPECT_LT(glm::length(light.direction - glm::vec3(-1, 0, 0)), 1e-6f);
}

TEST(GltfLights, absent_fields_take_the_extensions_defaults) {
  const Light point = with_light({{"type", "point"}}).load().lights.at(0);
  EXPECT_EQ(point.color, glm::vec3(1));
  EXPECT_EQ(point.intensity, 1);
  EXPECT_TRUE(std::isinf(point.radius_m));
  const Light spot = with_light({{"type", "spot"}, {"spot", {{"outerConeAngle", glm::pi<double>() / 4}}}})
                         .load()
                         .lights.at(0);
  EXPECT_EQ(spot.inner_cone_rad, 0);
  EXPECT_FLOAT_EQ(spot.outer_cone_rad, 0.78539816f);
  EXPECT_TRUE(std::isinf(with_light({{"type", "directional"}, {"range", 5}}).load().lights.at(0).radius_m));
}

TEST(GltfLights, one_light_on_many_nodes_is_many_lights) {
  GltfBuilder made = with_light({{"type", "point"}});
  json second = made.node();
  second["name"] = "second";
  second["translation"] = {4, 0, 0};
  made.root["nodes"].push_back(second);
  made.root["scenes"][0]["nodes"] = {0, 1};
  const Scene scene = made.load();
  ASSERT_EQ(scene.lights.size(), 2u);
  EXPECT_EQ(scene.lights[1].name, "second");
  EXPECT_EQ(scene.lights[1].position.x, 4);
}

TEST(GltfLights, what_the_extension_forbids_is_refused_by_name) {
  EXPECT_THAT(with_light({{"type", "point"}, {"intensity", 1e39}}).refusal(),
              HasSubstr("light 0: intensity is 1e+39"));
  EXPECT_THAT(with_light({{"type", "directional"}, {"color", {1, 1e9, 0}}, {"intensity", 1e30}}).refusal(),
              HasSubstr("light 0: intensity 1e+30 times color passes the largest float, 3.40282e+38"));
  EXPECT_THAT(with_light({{"type", "point"}, {"color", {1, 1}}}).refusal(), HasSubstr("color has 2 numbers"));
}

TEST(GltfLights, what_exporters_write_against_the_extension_is_read_with_a_warning) {
  const auto expect_light = [](const json& in, const Light& expected, const char* warning) {
    Light light;
    EXPECT_THAT(warnings_of([&] { light = with_light(in).load().lights.at(0); }), HasSubstr(warning)) << in;
    EXPECT_EQ(light.radius_m, expected.radius_m) << in;
    EXPECT_EQ(light.intensity, expected.intensity) << in;
    EXPECT_EQ(light.color, expected.color) << in;
  };
  const char* no_range = "it counts as no range";
  expect_light({{"type", "point"}, {"range", 0}}, {}, no_range);
  expect_light({{"type", "spot"}, {"spot", json::object()}, {"range", -3.5}}, {}, no_range);
  expect_light({{"type", "point"}, {"intensity", -1}}, {.intensity = 0}, "intensity is -1; it counts as 0");
  expect_light({{"type", "directional"}, {"color", {0.5, -0.25, 1}}}, {.color = {0.5f, 0, 1}},
               "color is -0.25; it counts as 0");
}

TEST(GltfLights, a_light_of_an_unknown_type_is_left_out_with_a_warning) {
  GltfBuilder made = with_light({{"type", "area"}, {"extras", {{"lightgrid", {{"light_groups", {3}}}}}}});
  json& lights = made.root["extensions"]["KHR_lights_punctual"]["lights"];
  lights.push_back({{"type", "point"}, {"extras", {{"lightgrid", {{"light_groups", {2}}}}}}});
  json second = made.node();
  second["extensions"]["KHR_lights_punctual"]["light"] = 1;
  made.root["nodes"].push_back(second);
  made.root["scenes"][0]["nodes"] = {0, 1};
  Scene scene;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), HasSubstr("light 0: type is \"area\""));
  ASSERT_EQ(scene.lights.size(), 1u);
  EXPECT_EQ(groups_of(scene.lights[0]), 1u << 2) << "the groups stay with their light";
}

// Sizes are multiplied by the node's largest scale, and the height lies along its y axis, mirrored or sheared.
TEST(GltfLights, rectangles_of_EXT_lights_area_are_area_lights) {
  GltfBuilder made = GltfBuilder::triangle();
  made.root["extensionsUsed"] = {"EXT_lights_area"};
  made.root["extensions"]["EXT_lights_area"]["lights"] = {{{"type", "rect"},
                                                           {"size", 0.5},
                                                           {"rect", {{"aspect", 2.0}}},
                                                           {"intensity", 100},
                                                           {"color", {1, 0.5, 0}}},
                                                          {{"type", "disk"}}};
  made.node()["extensions"]["EXT_lights_area"]["light"] = 0;
  made.node()["name"] = "panel";
  made.node()["matrix"] = {-1, 0, 0, 0, 0, 3, 0, 0, 0, 0.5, 1, 0, 7, 8, 9, 1};
  Scene scene = made.load();
  ASSERT_EQ(scene.lights.size(), 1u);
  const Light& light = scene.lights[0];
  EXPECT_EQ(light.name, "panel");
  EXPECT_EQ(light.position, glm::dvec3(7, 8, 9));
  ASSERT_TRUE(has_rectangle(light));
  EXPECT_EQ(height_of(light), 1.5);
  EXPECT_EQ(width_of(light), 3);
  EXPECT_EQ(light.intensity, 450);
  EXPECT_EQ(light.color, glm::vec3(1, 0.5, 0));
  const LightRectangle r = rectangle_of(light);
  expect_near(r.direction, glm::normalize(glm::dvec3(0, -0.5, -1)));
  EXPECT_NEAR(glm::dot(r.up, r.direction), 0, 1e-12);
  EXPECT_GT(r.up.y, 0);
  EXPECT_NEAR(glm::length(r.across), 1.5, 1e-12);
  made.node()["extensions"]["EXT_lights_area"]["light"] = 1;
  EXPECT_THAT(warnings_of([&] { scene = made.load(); }), HasSubstr("type is \"disk\", not rect"));
  EXPECT_TRUE(scene.lights.empty());
  EXPECT_TRUE(scene.has_own_lights);
  made.node()["extensions"]["EXT_lights_area"]["light"] = 2;
  EXPECT_THAT(made.refusal(), HasSubstr("EXT_lights_area.light is 2, but there are 2"));
}

// As fields of lights files, which are also extras.
TEST(GltfLights, extras_give_a_spot_its_rectangle) {
  const auto loaded = [](const json& fields) {
    return with_light({{"type", "spot"}, {"spot", json::object()}, {"extras", {{"lightgrid", fields}}}})
        .load()
        .lights.at(0);
  };
  const Light light = loaded({{"light_area_width", 2}, {"light_area_height", 0.5}});
  EXPECT_TRUE(has_rectangle(light));
  EXPECT_EQ(width_of(light), 2);
  EXPECT_FALSE(has_rectangle(loaded({{"light_area_width", 2}})));
}

TEST(GltfLights, what_is_wrong_with_a_light_matters_only_if_a_node_has_it) {
  GltfBuilder made = with_light({{"type", "point"}});
  made.root["extensions"]["KHR_lights_punctual"]["lights"].push_back(
      {{"type", "point"}, {"intensity", 1e39}});
  EXPECT_EQ(made.load().lights.size(), 1u);
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 1;
  EXPECT_THAT(made.refusal(), HasSubstr("light 1: intensity is 1e+39"));
  made.node()["extensions"]["KHR_lights_punctual"]["light"] = 2;
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: KHR_lights_punctual.light is 2, but there are 2"));
}

struct Cone {
  float inner, outer, intensity;
  std::string warning;
};
Cone cone_of(double inner, double outer) {
  Light light;
  const json cone = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
  const std::string warning = warnings_of([&] {
    light = with_light({{"type", "spot"}, {"name", "s"}, {"spot", cone}}).load().lights.at(0);
  });
  return {light.inner_cone_rad, light.outer_cone_rad, light.intensity, warning};
}

// Files of Blender, whose angles are floats: every spot with a blend of 0, and every spot of 180 degrees.
TEST(GltfLights, cones_with_hard_edges_and_of_90_degrees_in_float_are_read) {
  constexpr float right_angle = glm::half_pi<float>();
  const Cone hard = cone_of(0.6, 0.6), wide = cone_of(0.1, 1.5707963705062866),
             both = cone_of(1.5707963705062866, 1.5707963705062866),
             exact = cone_of(0.1, glm::half_pi<double>());
  EXPECT_EQ(hard.inner, 0.6f);
  EXPECT_EQ(hard.outer, 0.6f);
  EXPECT_EQ(wide.inner, 0.1f);
  EXPECT_EQ(wide.outer, right_angle);
  EXPECT_EQ(both.inner, right_angle);
  EXPECT_EQ(both.outer, right_angle);
  EXPECT_EQ(exact.outer, right_angle);
  for (const Cone& cone : {hard, wide, both, exact}) EXPECT_EQ(cone.warning, "");
}

TEST(GltfLights, cones_that_the_extension_forbids_become_the_nearest_with_a_warning) {
  const Cone inverted = cone_of(0.6, 0.5), wide = cone_of(0.1, 2), negative = cone_of(-0.1, 0.5),
             none = cone_of(0, 0);
  EXPECT_EQ(inverted.inner, 0.5f);
  EXPECT_EQ(inverted.outer, 0.5f);
  EXPECT_THAT(inverted.warning, HasSubstr("light 0 \"s\": spot.innerConeAngle is 0.6, outside 0 to 0.5"));
  EXPECT_EQ(wide.outer, glm::half_pi<float>());
  EXPECT_THAT(wide.warning, HasSubstr("spot.outerConeAngle is 2, outside 0 to 1.5707963"));
  EXPECT_EQ(negative.inner, 0);
  EXPECT_THAT(negative.warning, HasSubstr("spot.innerConeAngle is -0.1"));
  EXPECT_THAT(none.warning, HasSubstr("spot.outerConeAngle is 0; it lights nothing"));
  EXPECT_EQ(none.intensity, 0);
  EXPECT_EQ(inverted.intensity, 1);
}

TEST(GltfLights, cones_that_differ_by_less_than_a_float_still_differ) {
  const Light light =
      with_light({{"type", "spot"}, {"spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5 + 1e-12}}}})
          .load()
          .lights.at(0);
  EXPECT_LT(light.inner_cone_rad, light.outer_cone_rad);
}

TEST(GltfLights, a_light_without_a_direction_is_refused_where_it_needs_one) {
  GltfBuilder made = with_light({{"type", "directional"}});
  made.node().erase("mesh");
  made.node()["scale"] = {1, 1, 0};
  EXPECT_THAT(made.refusal(), HasSubstr("node 0: light 0 has no direction"));
}

}  // namespace
}  // namespace lightgrid
