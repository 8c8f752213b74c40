// Errors of the C interface: a status, a message and the field, never a crash.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "c_api/owned.h"

namespace lightgrid::app {
namespace {

using testing::HasSubstr;

void expect_wrong(lightgrid_status status, const std::string& field, const std::string& message = "") {
  EXPECT_EQ(status, LIGHTGRID_INPUT) << field;
  EXPECT_EQ(lightgrid_error_field(), field) << lightgrid_error_message();
  EXPECT_THAT(lightgrid_error_message(), HasSubstr(message.empty() ? field : message));
  EXPECT_THAT(lightgrid_error_message(), testing::Not(HasSubstr("\n")));
}

OwnedScene spheres() { return load_scene("spheres", {"size=64x36", "lights=8"}); }

TEST(CErrors, TellTheFieldOfAScene) {
  lightgrid_scene* scene = nullptr;
  const auto load = [&](const char* name, const Words& fields) {
    return lightgrid_scene_load(name, fields, &scene);
  };
  expect_wrong(load("hull", {}), "scene", "did you mean hall?");
  expect_wrong(load("hall", {"size=0x5"}), "size", "size 0x5: not WxH");
  expect_wrong(load("hall", {"lights=many"}), "lights", "lights many: not a number");
  expect_wrong(load("hall", {"lights=-1"}), "lights");
  expect_wrong(load("hall", {"light-radius=1,2"}), "light-radius");
  expect_wrong(load("hall", {"seed=x"}), "seed");
  expect_wrong(load("hall", {"camera=nowhere"}), "camera");
  expect_wrong(load("hall", {"shadow=all"}), "shadow", "did you mean shadows?");
  expect_wrong(load("hall", {"shadows"}), "shadows");
  expect_wrong(load("hall", {"ambient=-1"}), "ambient");
  expect_wrong(load("hall", {"exposure=100"}), "exposure");
  expect_wrong(load("hall", {"brdf="}), "brdf", "brdf is empty");
  expect_wrong(load("hall", {"brdf=phong"}), "brdf");
  expect_wrong(load("hall", {"camera-path=turn:0"}), "camera-path");
  expect_wrong(load("hall", {"light-motion=jump"}), "light-motion");
  expect_wrong(load("hall", {"files=all"}), "files", "files all: neither below");
  expect_wrong(load("hall", {"image-memory=4T"}), "image-memory");
  expect_wrong(load("hall", {"texture-size=9000"}), "texture-size");
  EXPECT_EQ(scene, nullptr);
}

TEST(CErrors, TellTheSetting) {
  const OwnedScene scene = spheres();
  lightgrid_view* view = nullptr;
  const auto open = [&](const char* technique, const Words& settings) {
    return lightgrid_view_open(opencl_device().get(), scene.get(), technique, settings, &view);
  };
  expect_wrong(open("visibility", {"tile=7"}), "tile", "set tile=7: \"7\" is not a value of tile");
  expect_wrong(open("visibility", {"tiles=8"}), "tiles", "did you mean tile?");
  expect_wrong(open("visibility:tile=9", {}), "tile");
  expect_wrong(open("visibility", {"lidr-sort=view"}), "lidr-sort", "visibility does not read it");
  expect_wrong(open("visibilty", {}), "technique", "did you mean visibility?");
  const OwnedScene automatic = load_scene("spheres", {"size=64x36", "exposure=auto"});
  expect_wrong(lightgrid_view_open(opencl_device().get(), automatic.get(), "visibility",
                                   Words{"picture=bytes"}, &view),
               "picture", "give --exposure a number");
  EXPECT_EQ(open("forward_plus", {}), LIGHTGRID_MACHINE);  // a device without OpenGL
  EXPECT_EQ(view, nullptr);
  lightgrid_device* device = nullptr;
  expect_wrong(lightgrid_device_open(nullptr, "vulkan", &device), "gl");
  EXPECT_EQ(lightgrid_device_open("no such device", "none", &device), LIGHTGRID_MACHINE);
  EXPECT_EQ(device, nullptr);
}

TEST(CErrors, TellTheFieldOfALight) {
  const OwnedScene scene = spheres();
  lightgrid_light good;
  lightgrid_default_light(&good);
  const float nan = std::nanf("");
  const auto set = [&](const auto& change) {
    lightgrid_light lights[2] = {good, good};
    change(lights[1]);
    return lightgrid_scene_set_lights(scene.get(), lights, 2);
  };
  must(set([](lightgrid_light&) {}));
  expect_wrong(set([&](lightgrid_light& l) { l.radius_m = nan; }), "lights[1].radius_m");
  expect_wrong(set([&](lightgrid_light& l) { l.radius_m = -1; }), "lights[1].radius_m");
  expect_wrong(set([&](lightgrid_light& l) { l.source_radius_m = nan; }), "lights[1].source_radius_m");
  expect_wrong(set([&](lightgrid_light& l) { l.source_radius_m = -INFINITY; }), "lights[1].source_radius_m");
  expect_wrong(set([&](lightgrid_light& l) { l.position[2] = INFINITY; }), "lights[1].position[2]");
  expect_wrong(set([&](lightgrid_light& l) { l.color[0] = -1; }), "lights[1].color[0]");
  expect_wrong(set([&](lightgrid_light& l) { l.type = lightgrid_light_type(9); }), "lights[1].type");
  expect_wrong(set([&](lightgrid_light& l) {
                 l.type = LIGHTGRID_SPOT;
                 l.direction[2] = 0;
               }),
               "lights[1].direction");
  expect_wrong(set([&](lightgrid_light& l) {
                 l.type = LIGHTGRID_SPOT;
                 l.outer_cone_rad = 0;
               }),
               "lights[1].outer_cone_rad");
  expect_wrong(set([&](lightgrid_light& l) {
                 l.type = LIGHTGRID_SPOT;
                 l.inner_cone_rad = 2 * l.outer_cone_rad;
               }),
               "lights[1].inner_cone_rad");
  expect_wrong(set([&](lightgrid_light& l) {
                 l.intensity = 3e38f;
                 l.color[0] = 9;
               }),
               "lights[1].intensity");
  size_t count = 0;
  must(lightgrid_scene_get_lights(scene.get(), nullptr, 0, &count));
  EXPECT_EQ(count, 2u);  // as before the errors
}

TEST(CErrors, TellTheFieldOfAnImage) {
  const OwnedScene scene = spheres();
  const OwnedView view = open_view(opencl_device(), scene, "visibility");
  Radiance image(64, 36);
  const auto render = [&](const auto& change) {
    lightgrid_image changed = image.image;
    change(changed);
    return lightgrid_view_render(view.get(), &changed);
  };
  expect_wrong(render([](lightgrid_image& i) { i.pixels = nullptr; }), "image.pixels");
  expect_wrong(render([](lightgrid_image& i) { i.width = 63; }), "image.width", "63 is not 64");
  expect_wrong(render([](lightgrid_image& i) { i.height = 0; }), "image.height");
  expect_wrong(render([](lightgrid_image& i) { i.row_bytes -= 4; }), "image.row_bytes");
  expect_wrong(render([](lightgrid_image& i) { i.row_bytes = 4 - i.row_bytes; }), "image.row_bytes");
  expect_wrong(render([](lightgrid_image& i) { i.row_bytes += 2; }), "image.pixels");
  expect_wrong(render([](lightgrid_image& i) { i.format = LIGHTGRID_R_F32; }), "image.format");
  expect_wrong(render([](lightgrid_image& i) { i.format = LIGHTGRID_RGBA_U8; }), "image.format");
  expect_wrong(lightgrid_view_depth(view.get(), &image.image), "depth.format");
  Floats depth(64, 36);
  expect_wrong(lightgrid_view_depth(view.get(), &depth.image), "view", "no frame");
  expect_wrong(lightgrid_view_look(view.get(), nullptr, 0, 36), "size");
}

TEST(CErrors, TellTheFieldOfAMesh) {
  lightgrid_scene* made = nullptr;
  must(lightgrid_scene_create(nullptr, nullptr, &made));
  const OwnedScene scene(made);
  float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  uint32_t indices[3] = {0, 1, 2};
  lightgrid_mesh mesh = {positions, nullptr, nullptr, nullptr, 3, indices, 3, 0};
  expect_wrong(lightgrid_scene_add_mesh(made, &mesh, nullptr), "mesh.material");
  lightgrid_material material;
  lightgrid_default_material(&material);
  material.roughness = 2;
  expect_wrong(lightgrid_scene_add_material(made, &material, nullptr), "material.roughness");
  lightgrid_default_material(&material);
  material.base_color[3] = 2;
  expect_wrong(lightgrid_scene_add_material(made, &material, nullptr), "material.base_color[3]");
  material.base_color[3] = 1;
  material.ior = 0.5f;
  expect_wrong(lightgrid_scene_add_material(made, &material, nullptr), "material.ior");
  material.ior = 0;  // all is reflected
  EXPECT_EQ(lightgrid_scene_add_material(made, &material, nullptr), LIGHTGRID_OK);
  material.roughness = 1;
  material.normal_map = 0;
  expect_wrong(lightgrid_scene_add_material(made, &material, nullptr), "material.normal_map");
  material.normal_map = -1;
  must(lightgrid_scene_add_material(made, &material, nullptr));
  mesh.index_count = 4;
  expect_wrong(lightgrid_scene_add_mesh(made, &mesh, nullptr), "mesh.index_count");
  mesh.index_count = 3;
  indices[2] = 3;
  expect_wrong(lightgrid_scene_add_mesh(made, &mesh, nullptr), "mesh.indices", "index 2 is 3");
  indices[2] = 2;
  positions[4] = NAN;
  expect_wrong(lightgrid_scene_add_mesh(made, &mesh, nullptr), "mesh.positions");
  positions[4] = 0;
  int32_t number = -1;
  must(lightgrid_scene_add_mesh(made, &mesh, &number));
  EXPECT_EQ(number, 0);
  expect_wrong(lightgrid_scene_add_instance(made, 1, nullptr, 1, nullptr), "mesh");
  double matrix[16] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  expect_wrong(lightgrid_scene_add_instance(made, 0, matrix, 1, nullptr), "world_from_object");
}

TEST(CErrors, AreWhatNullGives) {
  const OwnedScene scene = spheres();
  const OwnedView view = open_view(opencl_device(), scene, "visibility");
  lightgrid_device* const device = opencl_device().get();
  Radiance image(64, 36);
  lightgrid_projection projection;
  lightgrid_camera camera;
  lightgrid_lists* lists = nullptr;
  lightgrid_grid grid;
  lightgrid_report* report = nullptr;
  lightgrid_scene* made = nullptr;
  lightgrid_view* opened = nullptr;
  char* json = nullptr;
  double value = 0;
  size_t count = 0;
  int32_t side = 0;
  must(lightgrid_scene_camera(scene.get(), nullptr, 1, &camera));
  must(lightgrid_project(&camera, 64, 36, &projection));
  expect_wrong(lightgrid_describe(nullptr, &json), "table");
  expect_wrong(lightgrid_describe("techniques", nullptr), "json");
  expect_wrong(lightgrid_describe("tables", &json), "table");
  expect_wrong(lightgrid_exposure(nullptr, &value), "image");
  expect_wrong(lightgrid_exposure(&image.image, nullptr), "stops");
  expect_wrong(lightgrid_srgb(&image.image, 0, nullptr), "picture");
  expect_wrong(lightgrid_save(nullptr, &image.image, 0), "path");
  expect_wrong(lightgrid_save("x.png", nullptr, 0), "image");
  expect_wrong(lightgrid_save("x.png", &image.image, NAN), "stops");
  expect_wrong(lightgrid_measure(&image.image, nullptr, "rmse", &value), "reference");
  expect_wrong(lightgrid_measure(&image.image, &image.image, nullptr, &value), "measure");
  expect_wrong(lightgrid_measure(&image.image, &image.image, "nice", &value), "measure");
  expect_wrong(lightgrid_flip(&image.image, &image.image, 67, nullptr), "map");
  expect_wrong(lightgrid_device_open(nullptr, nullptr, nullptr), "device");
  expect_wrong(lightgrid_scene_load(nullptr, nullptr, &made), "name");
  expect_wrong(lightgrid_scene_load("hall", nullptr, nullptr), "scene");
  expect_wrong(lightgrid_scene_create(nullptr, nullptr, nullptr), "scene");
  expect_wrong(lightgrid_scene_add_texture(scene.get(), 1, 1, nullptr, 0, nullptr), "rgba");
  expect_wrong(lightgrid_scene_add_material(scene.get(), nullptr, nullptr), "material");
  expect_wrong(lightgrid_scene_add_mesh(scene.get(), nullptr, nullptr), "mesh");
  expect_wrong(lightgrid_scene_add_instance(nullptr, 0, nullptr, 0, nullptr), "scene");
  expect_wrong(lightgrid_scene_move_instance(scene.get(), -1, nullptr), "instance");
  expect_wrong(lightgrid_scene_set_lights(scene.get(), nullptr, 1), "lights");
  expect_wrong(lightgrid_scene_get_lights(scene.get(), nullptr, 1, &count), "lights");
  expect_wrong(lightgrid_scene_get_lights(scene.get(), nullptr, 0, nullptr), "count");
  expect_wrong(lightgrid_scene_set_light_properties(scene.get(), 0, nullptr), "json");
  expect_wrong(lightgrid_scene_set_light_properties(nullptr, 0, "{}"), "scene");
  expect_wrong(lightgrid_scene_set_light_properties(scene.get(), 9, "{}"), "light");
  expect_wrong(lightgrid_scene_set_light_properties(scene.get(), 0, "[]"), "json");
  expect_wrong(lightgrid_scene_get_light_properties(scene.get(), 0, nullptr), "json");
  expect_wrong(lightgrid_scene_camera(scene.get(), nullptr, NAN, &camera), "aspect");
  expect_wrong(lightgrid_scene_camera(scene.get(), nullptr, 1, nullptr), "camera");
  expect_wrong(lightgrid_view_open(nullptr, scene.get(), nullptr, nullptr, &opened), "device");
  expect_wrong(lightgrid_view_open(device, nullptr, nullptr, nullptr, &opened), "scene");
  expect_wrong(lightgrid_view_open(device, scene.get(), nullptr, nullptr, nullptr), "view");
  expect_wrong(lightgrid_view_look(nullptr, nullptr, 1, 1), "view");
  expect_wrong(lightgrid_view_size(view.get(), nullptr, &side), "width");
  expect_wrong(lightgrid_view_draw(nullptr, &image.image, nullptr), "view");
  expect_wrong(lightgrid_view_draw(view.get(), nullptr, nullptr), "image");
  lightgrid_frame_free(nullptr);
  expect_wrong(lightgrid_view_render(view.get(), nullptr), "image");
  expect_wrong(lightgrid_view_render(nullptr, &image.image), "view");
  expect_wrong(lightgrid_view_listed(view.get(), nullptr), "counts");
  expect_wrong(lightgrid_view_profile(view.get(), nullptr), "json");
  expect_wrong(lightgrid_project(nullptr, 1, 1, &projection), "camera");
  expect_wrong(lightgrid_cull(device, nullptr, nullptr, nullptr, 0, nullptr, nullptr, &lists), "projection");
  expect_wrong(lightgrid_cull(device, &projection, nullptr, nullptr, 0, nullptr, nullptr, &lists), "depth");
  expect_wrong(lightgrid_cull(device, &projection, nullptr, nullptr, 0, "forward", nullptr, &lists),
               "technique");
  expect_wrong(lightgrid_lists_get(nullptr, &grid), "lists");
  expect_wrong(lightgrid_rasterize(device, scene.get(), nullptr, nullptr, nullptr), "projection");
  expect_wrong(lightgrid_compare(nullptr, scene.get(), nullptr, nullptr, nullptr, nullptr, &report),
               "device");
  expect_wrong(lightgrid_compare(device, scene.get(), nullptr, Words{"frames=0"}, nullptr, nullptr, &report),
               "frames");
  expect_wrong(lightgrid_compare(device, scene.get(), nullptr, Words{"frame=1"}, nullptr, nullptr, &report),
               "frame");
  expect_wrong(lightgrid_report_image(nullptr, 0, &image.image), "report");
  expect_wrong(lightgrid_report_save(nullptr, nullptr), "folder");
  EXPECT_EQ(lightgrid_device_name(nullptr), nullptr);
  EXPECT_EQ(lightgrid_report_json(nullptr), nullptr);
  lightgrid_device_close(nullptr);
  lightgrid_scene_free(nullptr);
  lightgrid_view_close(nullptr);
  lightgrid_lists_free(nullptr);
  lightgrid_report_free(nullptr);
  lightgrid_free(nullptr);
  lightgrid_default_light(nullptr);
  lightgrid_default_material(nullptr);
  lightgrid_set_log(nullptr, nullptr);
  lightgrid_set_compiling(nullptr, nullptr);
}

// Worked out by hand: one pixel of 4 x 2 is off by 0.5 in red, and the brightest channel is 2.
TEST(CMeasures, AreThoseOfTheProgram) {
  Radiance image(4, 2), reference(4, 2);
  std::ranges::fill(reference.values, 1.0f);
  reference.values[4] = 2;
  image.values = reference.values;
  image.values[0] = 1.5f;
  const auto measured = [&](const char* name) {
    double value = -1;
    must(lightgrid_measure(&image.image, &reference.image, name, &value));
    return value;
  };
  EXPECT_EQ(measured("max_abs"), 0.5);
  EXPECT_EQ(measured("max_rel"), 0.25);
  EXPECT_DOUBLE_EQ(measured("rmse"), std::sqrt(0.25 / 24));
  EXPECT_DOUBLE_EQ(measured("energy_rel"), 0.5 / 25);
  char* json = nullptr;
  must(lightgrid_describe("measures", &json));
  for (const std::string name : nlohmann::json::parse(json)) EXPECT_FALSE(measured(name.c_str()) < 0) << name;
  lightgrid_free(json);
  Floats map(4, 2);
  must(lightgrid_flip(&image.image, &reference.image, 0, &map.image));
  double sum = 0;
  for (const float pixel : map.values) sum += pixel;
  EXPECT_NEAR(sum / 8, measured("flip_mean"), 1e-6);
  EXPECT_GT(sum, 0);
}

TEST(CLog, HasTheLinesOfTheProgram) {
  std::vector<std::string> lines;
  lightgrid_set_log(
      [](int, const char* line, void* to) { static_cast<std::vector<std::string>*>(to)->push_back(line); },
      &lines);
  load_scene("particles", {"size=64x36", "time=1"});
  lightgrid_set_log(nullptr, nullptr);
  load_scene("particles", {"size=64x36", "time=1"});
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("time 1: "));
}

nlohmann::json warnings() {
  char* json = nullptr;
  must(lightgrid_describe("warnings", &json));
  const auto list = nlohmann::json::parse(json);
  lightgrid_free(json);
  return list;
}

TEST(CWarnings, AreThoseOfTheLastCall) {
  load_scene("particles", {"size=64x36", "time=1"});
  const nlohmann::json of_scene = warnings();
  ASSERT_EQ(of_scene.size(), 1u);
  EXPECT_THAT(of_scene[0]["text"].get<std::string>(), HasSubstr("time 1: "));
  EXPECT_TRUE(of_scene[0]["command"].is_null());
  EXPECT_EQ(warnings(), of_scene) << "describing is none of the calls";
  load_scene("particles", {"size=64x36"});
  EXPECT_TRUE(warnings().empty());
}

// A suite of its own, and so a process in which nobody has asked for lines yet.
TEST(CSilence, IsWhatALibraryKeepsAtFirst) {
  testing::internal::CaptureStderr();
  load_scene("particles", {"size=64x36", "time=1"});
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace lightgrid::app
