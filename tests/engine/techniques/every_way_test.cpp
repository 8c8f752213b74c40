// Every way to list and to add lights shows forward's picture: techniques, their settings and forms of their
// kernels, on scenes in which a bound is easily wrong, and with each effect.
#include <cmath>

#include "passes/find_object_lights.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/lights_file.h"
#include "scene/load_gltf.h"
#include "scene/random.h"
#include "support/long_tests.h"
#include "support/shared_files.h"
#include "support/small_scene.h"
#include "techniques/crowded_scene.h"
#include "techniques/rendering.h"
#include "techniques/rounding_loss.h"

namespace lightgrid {
namespace {

struct Way {
  const char* name;
  const char* technique;
  Settings settings;
  bool in_one_sum = false;  // in forward's order and shader, so that pictures have forward's bytes
};

// Ways that draw lights one by one or a few at a time, or have their light loop in OpenCL, round
// differently: within 1e-5 of the brightest channel.
// Not a static object: settings that stand in other files must exist first.
const std::vector<Way>& ways() {
  static const std::vector<Way> all = {
      {"multipass", "forward_multipass", {}},
      {"zprepass", "forward_zprepass", {}},
      {"back_faces", "deferred", {{setting::volume_culling, VolumeCulling::back_faces}}},
      {"stencil", "deferred", {{setting::volume_culling, VolumeCulling::stencil}}},
      {"scissor", "deferred", {{setting::volume_culling, VolumeCulling::scissor}}},
      {"depth_bounds", "deferred", {{setting::volume_culling, VolumeCulling::depth_bounds}}},
      {"full_screen", "deferred", assigned("light-pass=full-screen")},
      {"tiled", "deferred_tiled", {}},
      {"compute", "forward_plus_compute", {{setting::kernel_shape, KernelShape::group}}},
      {"without_bounds", "forward", {{setting::depth_bounds, DepthBoundsMode::none}}, true},
      {"without_prepass", "forward", assigned("prepass=off"), true},
      {"plus", "forward_plus", {}, true},
      {"plus_bins",
       "forward_plus",
       {{setting::slice_spacing, SliceSpacing::linear}, {setting::z_bins, 16}},
       true},
      {"plus_masks", "forward_plus", {{setting::grid_lists, GridLists::masks}, {setting::z_bins, 256}}, true},
      {"clusters", "clustered", {}, true},
      {"clusters_bins",
       "clustered",
       {{setting::depth_bounds, DepthBoundsMode::none},
        {setting::z_bins, 64},
        {setting::kernel_shape, KernelShape::group}},
       true},
      {"clusters_masks",
       "clustered",
       {{setting::depth_bounds, DepthBoundsMode::none}, {setting::grid_lists, GridLists::masks}},
       true},
  };
  return all;
}

void expect_forwards_picture(const Scene& scene, const View& view, const Image& forward, const Way& way,
                             Settings settings) {
  SCOPED_TRACE(way.name);
  if (way.in_one_sum)
    expect_exact(scene, view, settings, forward, way.technique);
  else
    expect_close(scene, view, settings, forward, way.technique);
}

void expect_all_alike(const Scene& scene, const View& view, Brdf brdf = Brdf::ggx) {
  const Image forward = render(scene, view, "forward", {{setting::brdf, brdf}});
  EXPECT_EQ(count_nan_pixels(forward), 0u);
  for (const Way& way : ways()) {
    Settings settings = way.settings;
    settings.set(setting::brdf, brdf);
    expect_forwards_picture(scene, view, forward, way, settings);
  }
}

struct BuiltinEveryWay : testing::TestWithParam<const char*> {
  const Scene scene = find_builtin_scene(GetParam())->make();
};

TEST_P(BuiltinEveryWay, IsTheImageOfEveryLightAtEveryPixel) {
  for (const glm::ivec2 size : {glm::ivec2(17, 9), glm::ivec2(1, 1)}) {
    SCOPED_TRACE(size.x);
    expect_all_alike(scene, default_view(scene, size.x, size.y));
  }
}

TEST_P(BuiltinEveryWay, IsTheImageOfEveryLightThroughEveryCamera) {
  ASSERT_FALSE(scene.cameras.empty());
  for (const Camera& camera : scene.cameras) {
    SCOPED_TRACE(camera.name);
    expect_all_alike(scene, make_view(camera, 95, 53));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, BuiltinEveryWay, testing::Values("hall", "spheres", "terrain", "street"),
                         [](const auto& info) { return std::string(info.param); });

TEST(LargeEveryWay, AtASizeThatNothingDivides) {
  Scene scene = find_builtin_scene("terrain")->make();
  scene.lights.resize(16);
  expect_all_alike(scene, default_view(scene, 1279, 721));
}

TEST(SponzaEveryWay, IsTheImageOfEveryLightAtEveryPixel) {
  LIGHTGRID_NEEDS_SHARED("scenes/large/Sponza");
  LIGHTGRID_NEEDS_SHARED("bench/sponza_lights.json");
  Scene scene = load_gltf(shared_folder() / "scenes/large/Sponza/Sponza.gltf");
  const std::filesystem::path lights = shared_folder() / "bench/sponza_lights.json";
  scene.lights = load_lights_file(lights);
  scene.lights.resize(255);
  expect_all_alike(scene, make_view(choose_camera(scene, camera_of_lights_file(lights)), 320, 180));
}

// The small scene's wall and ball among lamps and torches of all sizes.
Scene lamps(int count, float max_m) {
  Scene scene = small_scene(false).scene;
  Random random(7);
  for (int i = 0; i < count; ++i) {
    const glm::vec3 at{random.uniform(-2, 2), random.uniform(-1.5f, 1.5f), random.uniform(-4.2f, 0.5f)};
    const float radius = random.uniform(0.1f, max_m);
    if (i % 5 == 4) {
      add_spot(scene, "torch", at, at + glm::vec3(random.uniform(-1, 1), random.uniform(-1, 1), -1),
               {1, 1, 1}, 0.2f, radius, 5, random.uniform(10, 100));
    } else {
      add_point(scene, "lamp", at, {1, random.uniform(0, 1), random.uniform(0, 1)}, 0.2f, radius);
    }
  }
  return scene;
}

// Counts about the lights of one draw and about the bits of a mask's word.
TEST(EveryWay, WithAnyNumberOfLights) {
  for (const int count : {0, 1, 7, 8, 9, 15, 16, 31, 32, 33, 255}) {
    SCOPED_TRACE(count);
    expect_all_alike(lamps(count, 1.5f), small_view(33, 19));
  }
}

// Sums of n terms round by n * 2^-24 of the sum at most. llvmpipe ends loops that pass over so many lights,
// as those with masks and z-bins do (LongLoops).
TEST(EveryWay, With65535Lights) {
  const Scene scene = lamps(65535, 0.3f);
  const View view = small_view(17, 9);
  const Image forward = render(scene, view, "forward");
  for (const Way& way : ways()) {
    const bool passes_over =
        way.settings[setting::grid_lists] == GridLists::masks || way.settings[setting::z_bins] > 1;
    if (!passes_over) expect_forwards_picture(scene, view, forward, way, way.settings);
  }
}

Scene lights_around_the_eye_and_past_the_far_plane() {
  SmallScene s = small_scene();
  add_point(s.scene, "around the eye", {0.1f, 0, 0.1f}, {1, 1, 1}, 5, 30);
  add_point(s.scene, "around the eye, ends before the wall", {0.1f, 0, 0.1f}, {1, 1, 1}, 5, 3);
  add_point(s.scene, "across the near plane", {0.05f, 0, -0.2f}, {1, 1, 1}, 5, 0.15f);
  add_point(s.scene, "behind", {0, 0, 3}, {1, 1, 1}, 5, 2);
  add_point(s.scene, "behind, reaches in", {0, 0, 2}, {1, 1, 1}, 50, 7);
  add_point(s.scene, "past far", {0, 0, -4.6f}, {1, 0, 0}, 5, 2);
  add_point(s.scene, "in front, past far", {0, 0.5f, -12}, {0, 1, 0}, 50, 9);
  add_point(s.scene, "fills the screen", {0, 0, -3.5f}, {1, 1, 1}, 1, 9);
  add_spot(s.scene, "eye in the cone", {0, 0, 1}, {0, 0, -4}, {1, 1, 1}, 9, 9, 10, 25);
  add_spot(s.scene, "away", {0, 0, -3.5f}, {0, 0, 0}, {1, 1, 1}, 9, 9, 10, 25);
  add_spot(s.scene, "hemisphere and more", {0.5f, 0, -3.5f}, {1, 0, -3.5f}, {1, 1, 1}, 1, 2, 10, 120);
  effect("blend").add(s);
  return s.scene;
}

// A light to which the wall is tangent, one to which it is tangent except for an ulp, and lights that graze
// it.
Scene tangent_lights() {
  SmallScene s = small_scene();
  for (const float radius : {1.0f, std::nextafter(1.0f, 2.0f), std::nextafter(1.0f, 0.0f), 1.0001f, 1.01f}) {
    add_point(s.scene, "tangent", {0.4f, 0.3f, -3}, {1, 1, 1}, 5, radius);
  }
  add_point(s.scene, "grazing", {0.2f, 0, -3.999f}, {1, 1, 1}, 1, 3);
  add_spot(s.scene, "along the wall", {-1.5f, 0, -3.9f}, {2, 0, -3.95f}, {1, 1, 1}, 5, 4, 2, 8);
  return s.scene;
}

Scene lights_that_reach_everywhere_or_nowhere() {
  SmallScene s = small_scene();
  for (const float radius : {0.0f, 1e-40f, 1e20f, std::numeric_limits<float>::infinity()}) {
    add_point(s.scene, "strange", {0.3f, 0.4f, -3.9f}, {1, 1, 1}, 1, radius);
    add_spot(s.scene, "strange", {0.3f, 0.4f, -2.9f}, {0.3f, 0, -4}, {1, 1, 1}, 1, radius, 10, 40);
  }
  return s.scene;
}

// Two coincident surfaces: the later one is visible, and lit once.
Scene surfaces_of_one_depth() {
  SmallScene s = small_scene();
  const int paint = add_material(s.scene, "paint", {0.1f, 0.9f, 0.2f}, 0, 0.5f);
  Mesh copy = s.scene.meshes[s.wall];
  copy.material = paint;
  add_instance(s.scene, "the wall again", add_mesh(s.scene, std::move(copy)));
  return s.scene;
}

View view_to(double far_m) {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.far_m = far_m;
  return make_view(camera, 95, 53);
}

struct HardScene {
  const char* name;
  Scene (*make)();
  std::vector<View> views;
};

struct HardSceneEveryWay : testing::TestWithParam<HardScene> {};

TEST_P(HardSceneEveryWay, IsTheImageOfEveryLightAtEveryPixel) {
  const Scene scene = GetParam().make();
  for (const View& view : GetParam().views) expect_all_alike(scene, view);
}

INSTANTIATE_TEST_SUITE_P(
    Of, HardSceneEveryWay,
    testing::Values(HardScene{"LightsAroundTheEyeAndPastTheFarPlane",
                              lights_around_the_eye_and_past_the_far_plane,
                              {view_to(4.5), view_to(std::numeric_limits<double>::infinity())}},
                    HardScene{"TangentLights", tangent_lights, {small_view(95, 53), small_view(1, 1)}},
                    HardScene{"LightsThatReachEverywhereOrNowhere",
                              lights_that_reach_everywhere_or_nowhere,
                              {small_view(95, 53)}},
                    HardScene{"SurfacesOfOneDepth", surfaces_of_one_depth, {small_view(95, 53)}},
                    HardScene{
                        "GlassInACrowd",
                        crowded_scene,
                        {small_view(95, 53), small_view(1, 1), orthographic_view(0), orthographic_view(-3)}}),
    [](const auto& info) { return std::string(info.param.name); });

// The cost of fixed point: normals deviate by 0.95 degrees (8 bits) or 0.004 (16), which highlights as narrow
// as in these scenes multiply by about 20; the rest in steps of 1/255 or 1/65535.
TEST(Deferred, LosesIn16And8BitsJustWhatTheGeometryBufferRounds) {
  for (const char* name : {"hall", "spheres"}) {
    SCOPED_TRACE(name);
    const Scene scene = find_builtin_scene(name)->make();
    expect_rounding_explains_the_loss("deferred", scene, default_view(scene, 160, 90));
  }
}

// The ways, and each other technique that is meant to show forward's picture.
std::vector<Way> all_ways() {
  std::vector<Way> all = ways();
  for (const Technique* technique : techniques()) {
    const bool has_way =
        std::ranges::any_of(ways(), [&](auto& way) { return technique->name == std::string(way.technique); });
    if (!has_way && !technique->approximate) all.push_back({technique->name, technique->name, {}});
  }
  return all;
}

struct EffectEveryWay : testing::TestWithParam<std::string> {};

// An effect has shaders and kernels of its own in each technique, which take a second to build: every way
// draws a third of the effects, and each third of the ways draws all.
TEST_P(EffectEveryWay, IsThereAsInForward) {
  SmallScene s = small_scene();
  effect(GetParam()).add(s);
  const View view = small_view(63, 37);
  const Image forward = render(s.scene, view, "forward");
  ASSERT_GT(brightest_channel(forward), 0.01f) << "a dark picture shows nothing";
  const size_t place = &effect(GetParam()) - effects().data();
  const std::vector<Way> all = all_ways();
  for (size_t i = 0; i < all.size(); ++i) {
    if ((i + place) % 3 == 0 || long_tests())
      expect_forwards_picture(s.scene, view, forward, all[i], all[i].settings);
  }
}

// Every effect's code takes long to build; two ways cover all shaders.
TEST_P(EffectEveryWay, IsThereWithEverythingOn) {
  SmallScene s = small_scene();
  effect(GetParam()).add(s);
  const View view = small_view(63, 37);
  const Image forward = render(s.scene, view, "forward");
  for (const Way& way : {ways()[1], ways()[2]}) {
    Settings settings = way.settings;
    settings.set(setting::everything_on, true);
    expect_forwards_picture(s.scene, view, forward, way, settings);
  }
}

INSTANTIATE_TEST_SUITE_P(Effects, EffectEveryWay, testing::ValuesIn(effect_names()),
                         [](const auto& info) { return info.param; });

TEST(EveryWay, BlinnPhongAndLambert) {
  for (const Brdf brdf : {Brdf::blinn, Brdf::lambert})
    expect_all_alike(lamps(40, 1.5f), small_view(63, 37), brdf);
}

// Without the scene's own memory; triangles in reverse order must only be one more index
// buffer.
size_t memory_of(const Scene& scene, const View& view, const char* technique, const Settings& settings = {}) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
  run.run_frame();
  const GlScene& gpu = run.view().gpu.in_gl();
  const size_t reversed = run.view().plan.reversed_triangles ? 4 * size_t(gpu.index_count()) : 0;
  EXPECT_EQ(gpu.reversed_triangle_bytes(), reversed) << technique;
  return run.result().memory_total - gpu.geometry_bytes() - reversed - gpu.texture_bytes();
}

TEST(EveryWay, TakesTheMemoryThatThePagesSay) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  const Scene& scene = s.scene;
  const View view = small_view(127, 73);
  const size_t pixels = 127 * 73, lights = 6 * 32;
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward_zprepass"));
  run.run_frame();
  RenderView& v = run.view();
  const size_t blended_pairs = v.caches.blended_object_lights.of(v).lights().size();
  const size_t pairs = v.caches.object_lights.of(v).lights().size() + blended_pairs;
  EXPECT_GT(pairs, 6u);
  EXPECT_GT(blended_pairs, 0u);
  for (const char* technique : {"forward_multipass", "forward_zprepass"}) {
    EXPECT_EQ(memory_of(scene, view, technique), memory_of(scene, view, "forward") + 4 * pairs) << technique;
  }
  for (const Way& way : ways()) {
    if (way.technique != std::string("deferred")) continue;
    for (const int bits : {8, 16, 32}) {
      Settings settings = way.settings;
      settings.set(setting::buffer_bits, bits);
      const size_t depth = way.settings[setting::volume_culling] == VolumeCulling::stencil ? 5 : 4;
      const size_t volumes = way.name == std::string("full_screen") ? 0 : 6 * 68 + light_mesh_bytes;
      EXPECT_EQ(memory_of(scene, view, "deferred", settings),
                pixels * (size_t(bits) + 16 + depth) + lights + volumes + 4 * blended_pairs)
          << way.name << " " << bits;
    }
  }
}

}  // namespace
}  // namespace lightgrid
