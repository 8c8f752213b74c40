// The C interface returns the bytes that the program writes.
#include <gmock/gmock.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "c_api/owned.h"
#include "run/technique_run.h"
#include "support/devices.h"
#include "support/read_files.h"
#include "support/run_program.h"
#include "support/small_scene.h"
#include "support/temp_folder.h"

namespace lightgrid::app {
namespace {

const Words hall_fields = {"size=133x71", "lights=40", "seed=3"};

OwnedScene hall() { return load_scene("hall", hall_fields); }

std::vector<std::string> of_hall(const char* command, std::vector<std::string> rest) {
  std::vector<std::string> words = {command, "hall", "--size", "133x71", "--lights", "40", "--seed", "3"};
  words.insert(words.end(), rest.begin(), rest.end());
  return words;
}

std::string saved(const TempFolder& folder, const char* extension, const Radiance& image, double stops = 0) {
  const std::string path = folder.path / (std::string("ours.") + extension);
  must(lightgrid_save(path.c_str(), &image.image, stops));
  return file_bytes(path);
}

void must_succeed(const std::vector<std::string>& arguments) {
  const ProgramRun run = run_program(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
}

class CImages : public testing::TestWithParam<const char*> {};

TEST_P(CImages, HaveTheBytesOfTheCommandLines) {
  const TempFolder folder;
  const std::string technique = GetParam(), exr = folder.path / "theirs.exr",
                    png = folder.path / "theirs.png";
  const bool opengl = !technique.starts_with("visibility");
  must_succeed(of_hall("render", {"-t", technique, "-o", exr}));
  must_succeed(of_hall("render", {"-t", technique, "-o", png, "--exposure", "1.5"}));
  const OwnedDevice own = opengl ? open_device("auto") : nullptr;
  const OwnedScene scene = hall();
  const OwnedView view = open_view(opengl ? own : opencl_device(), scene, technique.c_str());
  const Radiance image = rendered(view);
  EXPECT_TRUE(saved(folder, "exr", image) == file_bytes(exr));
  EXPECT_TRUE(saved(folder, "png", image, 1.5) == file_bytes(png));

  // From the top row on, with gaps between rows: the same pixels.
  constexpr int gap = 5;
  std::vector<float> top_first(size_t(133 * 4 + gap) * 71, -1);
  const ptrdiff_t row = 133 * 4 + gap;
  const lightgrid_image from_top = {&top_first[size_t(row) * 70], 133, 71, LIGHTGRID_RGBA_F32, -4 * row};
  must(lightgrid_view_render(view.get(), &from_top));
  for (int y = 0; y < 71; ++y) {
    ASSERT_EQ(std::memcmp(&top_first[size_t(row * (70 - y))], &image.values[size_t(133 * 4 * y)], 133 * 16),
              0)
        << y;
    ASSERT_EQ(top_first[size_t(row * (70 - y) + 133 * 4)], -1) << y;
  }
}

std::vector<float> values_of(const lightgrid_image& image) {
  const auto* from = static_cast<const float*>(image.pixels);
  return {from, from + size_t(image.width) * size_t(image.height) * 4};
}

void expect_frames_without_a_copy(const std::string& technique, const char* opengl) {
  SCOPED_TRACE(opengl);
  const OwnedDevice device = open_device(opengl);
  const OwnedScene scene = hall();
  OwnedView view = open_view(device, scene, technique.c_str());
  const std::vector<float> expected = rendered(view).values;
  lightgrid_image first{}, image{};
  must(lightgrid_view_draw(view.get(), &first, nullptr));
  EXPECT_EQ(first.width, 133);
  EXPECT_EQ(first.height, 71);
  EXPECT_EQ(first.format, LIGHTGRID_RGBA_F32);
  EXPECT_EQ(first.row_bytes, 133 * 16);
  EXPECT_TRUE(values_of(first) == expected);
  Floats depth(133, 71);
  must(lightgrid_view_depth(view.get(), &depth.image));  // leaves the image
  EXPECT_TRUE(values_of(first) == expected);
  std::fill_n(static_cast<float*>(first.pixels), 133 * 71 * 4, -1.f);  // shows in no later frame

  lightgrid_frame* frame = nullptr;
  must(lightgrid_view_draw(view.get(), &image, &frame));
  OwnedFrame held(frame);
  EXPECT_EQ(image.pixels, first.pixels);
  EXPECT_TRUE(values_of(image) == expected);
  EXPECT_TRUE(rendered(view).values == expected);
  EXPECT_TRUE(values_of(image) == expected);

  // A held frame outlives frames of other sizes, other scenes and the view.
  must(lightgrid_view_look(view.get(), nullptr, 64, 36));
  must(lightgrid_view_draw(view.get(), &first, &frame));
  OwnedFrame small(frame);
  const std::vector<float> of_small = values_of(first);
  EXPECT_EQ(first.width, 64);
  EXPECT_TRUE(of_small == rendered(view).values);
  lightgrid_light lamp;
  lightgrid_default_light(&lamp);
  must(lightgrid_scene_set_lights(scene.get(), &lamp, 1));
  EXPECT_FALSE(rendered(view).values == of_small);
  view.reset();
  EXPECT_TRUE(values_of(first) == of_small);
  EXPECT_TRUE(values_of(image) == expected);
}

TEST_P(CImages, AreDrawnWithoutACopy) {
  const std::string technique = GetParam();
  expect_frames_without_a_copy(technique, "auto");
  if (technique.starts_with("visibility")) expect_frames_without_a_copy(technique, "none");
}

// With picture=bytes: the bytes of lightgrid_srgb.
TEST_P(CImages, AreDrawnInBytes) {
  const std::string technique = GetParam();
  const OwnedDevice device = open_device("auto");
  const OwnedScene scene = load_scene("hall", {"size=133x71", "lights=40", "seed=3", "exposure=-1"});
  const OwnedView view = open_view(device, scene, technique.c_str(), {"picture=bytes"});
  const Radiance radiance = rendered(view);  // floats are still to be had
  std::vector<uint8_t> rgb(133 * 71 * 3), rgba(133 * 71 * 4);
  const lightgrid_image to_rgb = {rgb.data(), 133, 71, LIGHTGRID_RGB_U8, 133 * 3};
  must(lightgrid_srgb(&radiance.image, -1, &to_rgb));
  const lightgrid_image to_rgba = {rgba.data(), 133, 71, LIGHTGRID_RGBA_U8, 133 * 4};
  must(lightgrid_view_render(view.get(), &to_rgba));
  lightgrid_image drawn{};
  must(lightgrid_view_draw(view.get(), &drawn, nullptr));
  ASSERT_EQ(drawn.format, LIGHTGRID_RGBA_U8);
  ASSERT_EQ(drawn.row_bytes, 133 * 4);
  const auto* of_draw = static_cast<const uint8_t*>(drawn.pixels);
  for (size_t i = 0; i < 133 * 71; ++i) {
    for (size_t c = 0; c < 4; ++c) {
      ASSERT_EQ(rgba[4 * i + c], of_draw[4 * i + c]) << i;
      const int expected = c < 3 ? rgb[3 * i + c] : 255;  // a GPU's OpenGL may be a step off
      ASSERT_LE(std::abs(int(of_draw[4 * i + c]) - expected), technique == "visibility" ? 0 : 1) << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Of, CImages, testing::Values("visibility", "forward_plus:tile=32"));

std::string bytes_of(const auto* values, size_t count) {
  return {reinterpret_cast<const char*>(values), count * sizeof(*values)};
}

// The view's depth is used, which is a rasterised scene's.
TEST(CLists, HaveTheBytesOfTheCommandLines) {
  const TempFolder folder;
  const std::string frame = folder.path / "frame", lists_folder = folder.path / "lists";
  must_succeed(of_hall("capture", {"-t", "visibility", "-o", frame, "--gl", "none"}));
  must_succeed({"cull", frame, "-o", lists_folder, "--set", "tile=32", "--set", "cull-test=exact", "--set",
                "grid-lists=masks"});
  const OwnedScene scene = hall();
  const OwnedView view = open_view(opencl_device(), scene, "visibility");
  rendered(view);
  Floats depth(133, 71), drawn(133, 71);
  must(lightgrid_view_depth(view.get(), &depth.image));
  EXPECT_TRUE(bytes_of(depth.values.data(), depth.values.size()) == file_bytes(frame + "/depth.f32"));

  lightgrid_camera camera;
  lightgrid_projection projection;
  must(lightgrid_scene_camera(scene.get(), nullptr, 133.0 / 71, &camera));
  must(lightgrid_project(&camera, 133, 71, &projection));
  Counts triangles(133, 71);
  must(lightgrid_rasterize(opencl_device().get(), scene.get(), &projection, &triangles.image, &drawn.image));
  EXPECT_EQ(drawn.values, depth.values);
  for (size_t i = 0; i < depth.values.size(); ++i)
    ASSERT_EQ(triangles.values[i] == 0xffffffffu, depth.values[i] == 0) << i;

  size_t count = 0;
  must(lightgrid_scene_get_lights(scene.get(), nullptr, 0, &count));
  ASSERT_EQ(count, 40u);
  std::vector<lightgrid_light> lights(count);
  must(lightgrid_scene_get_lights(scene.get(), lights.data(), count, &count));
  lightgrid_lists* culled = nullptr;
  must(lightgrid_cull(opencl_device().get(), &projection, &depth.image, lights.data(), count,
                      "forward_plus:tile=32", Words{"cull-test=exact", "grid-lists=masks"}, &culled));
  const OwnedLists owned(culled);
  lightgrid_grid grid;
  must(lightgrid_lists_get(culled, &grid));
  EXPECT_EQ(grid.cells_x, 5);
  EXPECT_EQ(grid.cells_y, 3);
  EXPECT_GT(grid.index_count, 0u);
  EXPECT_TRUE(bytes_of(grid.cells, 2 * grid.cell_count) == file_bytes(lists_folder + "/grid.u32"));
  EXPECT_TRUE(bytes_of(grid.indices, grid.index_count) == file_bytes(lists_folder + "/indices.u32"));
  EXPECT_TRUE(bytes_of(grid.masks, grid.mask_words * grid.cell_count) ==
              file_bytes(lists_folder + "/masks.u32"));
}

// Every pixel's list, and its count as view_listed gives it.
TEST(CLists, AreCountedAtEachPixel) {
  const OwnedScene scene = hall();
  const OwnedView view = open_view(opencl_device(), scene, "visibility:tile=32");
  rendered(view);
  Floats depth(133, 71);
  Counts listed(133, 71);
  must(lightgrid_view_depth(view.get(), &depth.image));
  must(lightgrid_view_listed(view.get(), &listed.image));
  lightgrid_camera camera;
  lightgrid_projection projection;
  must(lightgrid_scene_camera(scene.get(), "", 133.0 / 71, &camera));
  must(lightgrid_project(&camera, 133, 71, &projection));
  std::vector<lightgrid_light> lights(40);
  size_t count = 0;
  must(lightgrid_scene_get_lights(scene.get(), lights.data(), lights.size(), &count));
  lightgrid_lists* culled = nullptr;
  must(lightgrid_cull(opencl_device().get(), &projection, &depth.image, lights.data(), count, nullptr,
                      Words{"tile=32"}, &culled));
  const OwnedLists owned(culled);
  lightgrid_grid grid;
  must(lightgrid_lists_get(culled, &grid));
  for (int y = 0; y < 71; ++y) {
    for (int x = 0; x < 133; ++x) {
      ASSERT_EQ(listed.values[size_t(y * 133 + x)], grid.cells[2 * (y / 32 * grid.cells_x + x / 32) + 1]);
    }
  }
}

nlohmann::json without_times(nlohmann::json json) {
  if (json.is_object())
    for (const char* key : {"frame_ms", "frame_cpu_ms", "clock", "relative_time", "relative_cpu_time",
                            "speedup", "passes", "memory_bytes", "built_with", "commit"})
      json.erase(key);
  if (json.is_structured())
    for (nlohmann::json& value : json) value = without_times(value);
  return json;
}

TEST(CCompare, HasTheResultsOfTheCommandLine) {
  const TempFolder folder;
  must_succeed(of_hall("compare", {"-t", "visibility:lights=all,visibility:tile=32", "--gl", "none",
                                   "--frames", "1", "-o", folder.path / "theirs"}));
  const OwnedScene scene = hall();
  lightgrid_report* compared = nullptr;
  std::vector<double> done;
  const auto note = [](double share, const char*, void* to) {
    static_cast<std::vector<double>*>(to)->push_back(share);
    return 0;
  };
  must(lightgrid_compare(opencl_device().get(), scene.get(),
                         Words{"visibility:lights=all", "visibility:tile=32"}, Words{"frames=1"}, note, &done,
                         &compared));
  const OwnedReport report(compared);
  const auto ours = nlohmann::json::parse(lightgrid_report_json(compared)),
             theirs = nlohmann::json::parse(file_bytes(folder.path / "theirs/results.json"));
  EXPECT_EQ(without_times(ours), without_times(theirs));
  EXPECT_EQ(ours.at("rows").size(), 2u);
  ASSERT_GT(done.size(), 2u);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_EQ(done.back(), 1);

  Radiance image(133, 71);
  must(lightgrid_report_image(compared, 1, &image.image));
  const OwnedView view = open_view(opencl_device(), scene, "visibility:tile=32");
  EXPECT_EQ(image.values, rendered(view).values);
  must(lightgrid_report_save(compared, (folder.path / "ours").c_str()));
  EXPECT_TRUE(std::filesystem::exists(folder.path / "ours/index.html"));
}

TEST(CCompare, EndsWhereTheProgressFunctionWantsTo) {
  const OwnedScene scene = hall();
  int calls = 0;
  const auto second = [](double, const char*, void* user) { return int(++*static_cast<int*>(user) == 2); };
  lightgrid_report* report = nullptr;
  EXPECT_EQ(lightgrid_compare(opencl_device().get(), scene.get(), Words{"visibility"}, nullptr, second,
                              &calls, &report),
            LIGHTGRID_CANCELLED);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(report, nullptr);
  rendered(open_view(opencl_device(), scene, "visibility"));  // the device still works
}

TEST(CThreads, EachHasADeviceOfItsOwn) {
  for (const char* opengl : {"none", "auto"}) {
    const char* const technique = opengl == std::string("none") ? "visibility" : "forward_plus";
    std::vector<float> images[2];
    const auto draw = [&](int i) {
      const OwnedDevice device = open_device(opengl);
      const OwnedScene scene = hall();
      const OwnedView view = open_view(device, scene, technique);
      images[i] = rendered(view).values;
      for (int frame = 0; frame < 5; ++frame) EXPECT_EQ(rendered(view).values, images[i]);
    };
    std::thread other([&] { draw(1); });
    draw(0);
    other.join();
    EXPECT_EQ(images[0], images[1]);
  }
}

// Opened by one thread, drawn by another, closed by a third.
TEST(CThreads, MayTakeTurns) {
  const OwnedScene scene = hall();
  OwnedDevice device;
  OwnedView view;
  std::vector<float> first, second;
  std::thread([&] {
    device = open_device("auto");
    view = open_view(device, scene, "forward_plus");
  }).join();
  std::thread([&] { first = rendered(view).values; }).join();
  second = rendered(view).values;
  std::thread([&] {
    device.reset();
    view.reset();
  }).join();
  EXPECT_EQ(first, second);
}

TEST(CThreads, OfOneDeviceTakeTurns) {
  for (const char* opengl : {"none", "auto"}) {
    const OwnedDevice device = open_device(opengl);
    const OwnedScene scenes[] = {hall(), hall()};
    const char* const technique = opengl == std::string("none") ? "visibility" : "forward_plus";
    const std::vector<float> expected = rendered(open_view(device, scenes[0], technique)).values;
    const auto draw = [&](int i) {
      const OwnedView view = open_view(device, scenes[i], technique);
      for (int frame = 0; frame < 5; ++frame) EXPECT_TRUE(rendered(view).values == expected);
    };
    std::thread other([&] { draw(1); });
    draw(0);
    other.join();
  }
}

// The same scene by arrays.
OwnedScene in_c(const Scene& from, const Words& fields) {
  lightgrid_scene* made = nullptr;
  must(lightgrid_scene_create("small", fields, &made));
  OwnedScene scene(made);
  for (const Material& m : from.materials) {
    lightgrid_material material;
    lightgrid_default_material(&material);
    for (int i = 0; i < 4; ++i) material.base_color[i] = m.base_color[i];
    material.metallic = m.metallic;
    material.roughness = m.roughness;
    must(lightgrid_scene_add_material(made, &material, nullptr));
  }
  for (const Mesh& m : from.meshes) {
    const lightgrid_mesh mesh = {&m.positions[0].x, &m.normals[0].x,    m.uv0.empty() ? nullptr : &m.uv0[0].x,
                                 nullptr,           m.positions.size(), m.indices.data(),
                                 m.indices.size(),  m.material};
    must(lightgrid_scene_add_mesh(made, &mesh, nullptr));
  }
  for (const Instance& i : from.instances)
    must(lightgrid_scene_add_instance(made, i.mesh, &i.world_from_object[0][0], i.casts_shadow, nullptr));
  must(lightgrid_scene_set_ambient(made, &from.ambient.x, &from.background.x));
  return scene;
}

std::vector<lightgrid_light> lamps_of(const Scene& from) {
  std::vector<lightgrid_light> lamps;
  for (const Light& l : from.lights) {
    lightgrid_light& lamp = lamps.emplace_back();
    lightgrid_default_light(&lamp);
    for (int i = 0; i < 3; ++i) {
      lamp.position[i] = l.position[i];
      lamp.color[i] = l.color[i];
    }
    lamp.intensity = l.intensity;
    lamp.radius_m = l.radius_m;
    lamp.casts_shadow = l.casts_shadow;
  }
  return lamps;
}

const Words small_fields = {"camera=eye:0,0,0,target:0,0,-1,near:0.1", "size=320x180"};

std::vector<float> drawn_in_cpp(const Scene& scene, const char* technique) {
  const View view = make_view(choose_camera(scene, "eye:0,0,0,target:0,0,-1,near:0.1"), 320, 180);
  Renderer& devices = std::string(technique) == "visibility" ? opencl_devices() : test_devices();
  TechniqueRun run(devices, scene, view, {}, find_technique(technique));
  run.run_frame();
  std::vector<float> values(run.image().pixels.size() * 4);
  std::memcpy(values.data(), run.image().pixels.data(), values.size() * 4);
  return values;
}

class CScenes : public testing::TestWithParam<const char*> {};

TEST_P(CScenes, FromArraysAreDrawnAsTheirCppTwinsAndFollowWhatMoves) {
  const std::string technique = GetParam();
  SmallScene small = small_scene_of_casters();
  std::vector<Light>& theirs = small.scene.lights;
  for (Light& light : theirs) light.radius_m = 1.3f;
  const OwnedDevice device = open_device(technique == "visibility" ? "none" : "auto");
  const OwnedScene scene = in_c(small.scene, small_fields);
  std::vector<lightgrid_light> ours = lamps_of(small.scene);
  must(lightgrid_scene_set_lights(scene.get(), ours.data(), ours.size()));
  const OwnedView view = open_view(device, scene, technique.c_str());
  std::vector<float> before = rendered(view).values;
  EXPECT_TRUE(before == drawn_in_cpp(small.scene, technique.c_str()));
  const auto expect_the_same = [&](const char* what) {
    const std::vector<float> now = rendered(view).values;
    EXPECT_FALSE(now == before) << what;
    EXPECT_TRUE(now == drawn_in_cpp(small.scene, technique.c_str())) << what;
    before = now;
  };
  const auto set_lights = [&] { must(lightgrid_scene_set_lights(scene.get(), ours.data(), ours.size())); };

  ours[1].position[0] += 1.7;
  theirs[1].position.x += 1.7;
  ours[4].radius_m = 2.2f;
  theirs[4].radius_m = 2.2f;
  ours[3].color[1] = 0.25f;
  theirs[3].color.y = 0.25f;
  ours[5].intensity = 5;
  theirs[5].intensity = 5;
  set_lights();
  expect_the_same("lights that move and change");

  glm::dmat4& ball = small.scene.instances[1].world_from_object;
  ball[3].x -= 0.6;
  must(lightgrid_scene_move_instance(scene.get(), 1, &ball[0][0]));
  expect_the_same("an instance that moves");

  ours[0].type = LIGHTGRID_DIRECTIONAL;
  theirs[0].type = LightType::directional;
  ours[2].type = LIGHTGRID_SPOT;
  theirs[2].type = LightType::spot;
  set_lights();
  expect_the_same("lights of other types");

  ours.pop_back();
  theirs.pop_back();
  set_lights();
  expect_the_same("fewer lights");

  add_instance(small.scene, "ball", small.ball, placed({-0.6, 0.4, -3.2}));
  must(lightgrid_scene_add_instance(scene.get(), small.ball,
                                    &small.scene.instances.back().world_from_object[0][0], 1, nullptr));
  expect_the_same("an instance more");
}

INSTANTIATE_TEST_SUITE_P(Of, CScenes, testing::Values("visibility", "forward_plus", "world_grid"));

TEST(CScenes, HaveThePropertiesOfLightsFiles) {
  const SmallScene small = small_scene();
  const OwnedScene scene = in_c(small.scene, {});
  std::vector<lightgrid_light> lights = lamps_of(small.scene);
  const auto properties = [&] {
    char* json = nullptr;
    must(lightgrid_scene_get_light_properties(scene.get(), 1, &json));
    const std::string text = json;
    lightgrid_free(json);
    return text;
  };
  must(lightgrid_scene_set_lights(scene.get(), lights.data(), lights.size()));
  EXPECT_EQ(properties(), "{}");
  must(lightgrid_scene_set_light_properties(scene.get(), 1, R"({"groups": ["kitchen", 3]})"));
  EXPECT_EQ(properties(), R"({"groups":[0,3]})");
  size_t count = 0;
  must(lightgrid_scene_get_lights(scene.get(), lights.data(), lights.size(), &count));
  EXPECT_EQ(lights[1].groups, 9u);
  lights[1].groups = 4;
  must(lightgrid_scene_set_lights(scene.get(), lights.data(), lights.size()));
  EXPECT_EQ(properties(), R"({"groups":[2]})");
  EXPECT_EQ(lightgrid_scene_set_light_properties(scene.get(), 1, R"({"groups": [32]})"), LIGHTGRID_INPUT);
  EXPECT_STREQ(lightgrid_error_message(),
               "light 1: groups [32] is not a list of names and whole numbers from 0 to 31");
  EXPECT_STREQ(lightgrid_error_field(), "groups");
}

}  // namespace
}  // namespace lightgrid::app
