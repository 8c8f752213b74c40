// light_prepass: light from lists and from volumes, hard cases, and memory.
#include <functional>

#include "base/error.h"
#include "passes/common/prepass_settings.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/random.h"
#include "techniques/light_prepass_by_hand.h"

namespace lightgrid {
namespace {

using namespace light_prepass_by_hand;

Settings tiles() {
  Settings s = volumes(PrepassSpecular::fifth_term);
  apply_setting(s, "prepass-lights=tiles");
  return s;
}

// Every kind of surface; a spot light, so that all tests of lists share a kernel.
Scene with_effects(std::initializer_list<const char*> names) {
  SmallScene s = small_scene();
  for (const char* name : names) effect(name).add(s);
  return s.scene;
}

TEST(LightPrepass, AddsTheSameLightFromListsAndFromVolumes) {
  const Scene scene = with_effects({"blend", "mask", "normal_map", "emissive_map", "occlusion_map",
                                    "metallic_roughness_map", "clearcoat", "spot", "directional"});
  for (const glm::ivec2 size : {glm::ivec2(71, 37), glm::ivec2(17, 9), glm::ivec2(1, 1)}) {
    const View view = small_view(size.x, size.y);
    const Image by_volumes = render(scene, view, "light_prepass", volumes(PrepassSpecular::fifth_term));
    expect_close(scene, view, tiles(), by_volumes, "light_prepass");
    Settings settings = tiles();
    settings.set(setting::kernel_shape, KernelShape::group);
    if (size.x > 1) expect_close(scene, view, settings, by_volumes, "light_prepass");
  }
}

// Once, where the sum is stored: half a step, and what 0.004 degrees of the normal change.
TEST(LightPrepass, RoundsSumsOfListsOnce) {
  const Scene scene = with_effects({"normal_map", "spot"});
  const View view = small_view(71, 37);
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.lists = {.light_grid = true}}));
  const Image exact = render(scene, view, "light_prepass", volumes(PrepassSpecular::plain, Brdf::lambert));
  Settings settings{{setting::brdf, Brdf::lambert},
                    {setting::buffer_bits, 8},
                    {setting::normals, NormalFormat::octahedral}};
  const double error = compare_images(render(scene, view, "light_prepass", settings), exact).max_abs;
  EXPECT_LE(error, 0.5 * scale / 255 / pi + 1e-4 * brightest_channel(exact));
  EXPECT_GE(error, 0.1 * scale / 255 / pi);
}

// Its own triangles in OpenCL: at silhouettes the image may differ, inside it is the same.
TEST(LightPrepass, DrawsWithOpenClAlone) {
  const Scene scene = with_effects({"clearcoat", "minnaert", "spot", "directional"});
  const View view = small_view(71, 37);
  const Image with_gl = render(scene, view, "light_prepass", tiles());
  Settings settings = tiles();
  settings.set(setting::raster, RasterApi::opencl);
  expect_close(scene, view, settings, with_gl, "light_prepass");
  EXPECT_LT(distance_of(render(scene, view, "light_prepass", settings), with_gl).median, 1e-5);
  apply_setting(settings, "prepass-lights=volumes");
  EXPECT_THROW(render(scene, view, "light_prepass", settings), Error);
}

struct HardCase {
  const char* name;
  std::function<void(SmallScene&)> add;
  bool in_all_formats = false;  // each has programs of its own
};

// Lists lose nothing, and no pixel is NaN, whichever way the light is added up.
TEST(LightPrepass, HardCases) {
  const auto point = [](glm::dvec3 at, float intensity, float radius) {
    return [=](SmallScene& s) { add_point(s.scene, "hard", at, {1, 0.5f, 0.2f}, intensity, radius); };
  };
  const auto roughness = [](float r) {
    return [=](SmallScene& s) {
      for (Material& m : s.scene.materials) m.roughness = r;
    };
  };
  const HardCase cases[] = {
      {"in the wall's plane", point({0.2, 0, -4}, 2, 2)},
      {"a hair before the wall", point({0.2, 0.1, -3.9999}, 2, 2)},
      {"behind the wall", point({0.2, 0.1, -4.3}, 2, 2)},
      {"around the eye", point({0.05, 0, 0.05}, 5, 30)},
      {"without a range", point({0, 0, -2}, 1, std::numeric_limits<float>::infinity())},
      {"larger than everything", point({0, 0, -2}, 1, 1e20f)},
      {"of no size", point({0.3, 0, -3.99}, 1, 1e-40f)},
      {"of range 0", point({0.3, 0, -3.99}, 1, 0)},
      {"black", point({0.3, 0, -3}, 0, 3)},
      {"bright beyond half floats", point({0.3, 0, -3}, 1e30f, 3), true},
      {"an infinitely thin spot",
       [](SmallScene& s) {
         add_spot(s.scene, "thin", {0, 0, -1}, {0.1, 0, -4}, {1, 1, 1}, 9, 9, 0, 1e-5f);
       }},
      {"many in one place",
       [&](SmallScene& s) {
         for (int i = 0; i < 1000; ++i) point({0.3, 0.2, -3.5}, 0.001f, 1)(s);
       }},
      {"a mirror", roughness(0), true},
      {"the roughest", roughness(1)},
      {"unlit", effect("unlit").add},
      {"surfaces of one depth",
       [](SmallScene& s) {
         Mesh copy = s.scene.meshes[s.wall];
         copy.material = s.ball_material;
         for (glm::vec3& normal : copy.normals) normal = glm::normalize(glm::vec3(0.6f, 0, 1));
         add_instance(s.scene, "again", add_mesh(s.scene, std::move(copy)));
       }},
      {"at random",
       [](SmallScene& s) {
         Random random(11);
         for (int i = 0; i < 200; ++i) {
           const glm::vec3 at{random.uniform(-2, 2), random.uniform(-1.5f, 1.5f),
                              random.uniform(-4.2f, 0.5f)};
           add_point(s.scene, "lamp", at, {1, random.uniform(0, 1), random.uniform(0, 1)}, 0.2f,
                     random.uniform(0.1f, 1.5f));
         }
       }},
  };
  const View view = small_view(33, 19);
  for (const HardCase& hard : cases) {
    SCOPED_TRACE(hard.name);
    SmallScene s = small_scene();
    effect("spot").add(s);
    hard.add(s);
    Settings stencil = volumes(PrepassSpecular::fifth_term);
    stencil.set(setting::volume_culling, VolumeCulling::stencil);
    expect_close(s.scene, view, stencil, render(s.scene, view, "light_prepass", tiles()), "light_prepass");
    expect_close(s.scene, view, tiles(), render(s.scene, view, "light_prepass", stencil), "light_prepass");
    for (const PrepassSpecular specular : variants) {
      for (const int bits : hard.in_all_formats ? std::vector{8, 16} : std::vector<int>()) {
        Settings settings = volumes(specular);
        settings.set(setting::buffer_bits, bits);
        settings.set(setting::normals, NormalFormat::xyz8);
        EXPECT_EQ(count_nan_pixels(render(s.scene, view, "light_prepass", settings)), 0u) << bits;
      }
    }
  }
}

TEST(LightPrepass, WithoutPointAndSpotLightsIsForwardsBytes) {
  SmallScene s = small_scene(false);
  effect("directional").add(s);
  const View view = small_view(33, 19);
  EXPECT_TRUE(identical(render(s.scene, view, "light_prepass"), render(s.scene, view, "forward")));
}

// docs/techniques/light_prepass.md#what-it-costs, computed by hand.
TEST(LightPrepass, TakesTheMemoryThatItsPageSays) {
  const Scene scene = with_effects({"spot"});
  const View view = small_view(64, 40);
  const size_t pixels = 64 * 40, lights = 7 * 48, none_of_three_kinds = 3 * 16;
  const auto result_of = [&](const char* technique, const Settings& settings) {
    TechniqueRun run(test_devices(), scene, view, settings, find_technique(technique));
    run.run_frame();
    return run.result();
  };
  const size_t scene_bytes = result_of("deferred", {}).memory_total - pixels * (32 + 16 + 4);
  for (const auto& [bits, sums] : {std::pair<int, size_t>(8, 4), {16, 8}, {32, 16}}) {
    for (const auto& [format, normal] :
         {std::pair<NormalFormat, size_t>(NormalFormat::floats, 16), {NormalFormat::spheremap, 4}}) {
      Settings settings = volumes(PrepassSpecular::plain, Brdf::ggx);
      settings.set(setting::buffer_bits, bits);
      settings.set(setting::normals, format);
      EXPECT_EQ(result_of("light_prepass", settings).memory_gbuffer, pixels * (normal + sums));
      EXPECT_EQ(result_of("light_prepass", settings).memory_total,
                scene_bytes + pixels * (normal + sums + 16 + 4));
      settings.set(setting::prepass_specular, PrepassSpecular::fifth_term);
      EXPECT_EQ(result_of("light_prepass", settings).memory_gbuffer, pixels * (normal + sums + sums / 2));
    }
  }
  const FrameFigures of_tiles = result_of("light_prepass", tiles());
  EXPECT_EQ(of_tiles.memory_gbuffer, pixels * 40);
  EXPECT_EQ(of_tiles.memory_total - result_of("forward_plus", {}).memory_total,
            pixels * 40 + (pixels + 16) * 40 + lights + none_of_three_kinds + sizeof(ViewParams));
}

// Also the code of skin and Minnaert, which no surface here has.
TEST(LightPrepass, EverythingOnChangesNoByte) {
  const Scene scene = small_scene().scene;
  const View view = small_view(33, 19);
  EXPECT_TRUE(identical(render(scene, view, "light_prepass", {{setting::everything_on, true}}),
                        render(scene, view, "light_prepass")));
}

}  // namespace
}  // namespace lightgrid
