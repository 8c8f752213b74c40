// Light from surroundings: every technique against forward, pictures against the oracle and against values by
// hand, and what it costs where there is none.
#include "scene/environment_light.h"

#include "accuracy/oracle_sample.h"
#include "accuracy/surfaces_in_double.h"
#include "effects/effects.h"
#include "oracle/position.h"
#include "plan/frame_plan.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

std::shared_ptr<const Environment> constant(const glm::vec3& radiance) {
  return make_environment({"constant", 1, 1, {radiance}});
}

// A sky with a bright patch towards +x, +z, which the ball mirrors.
std::shared_ptr<const Environment> patched_sky() {
  static const std::shared_ptr<const Environment> made = [] {
    RadianceMap map{"patched", 64, 32, {}};
    for (int row = 0; row < 32; ++row) {
      for (int column = 0; column < 64; ++column) {
        const bool patch = row >= 9 && row < 13 && column >= 38 && column < 44;
        map.texels.push_back(patch      ? glm::vec3(20, 18, 15)
                             : row < 16 ? glm::vec3(0.3f, 0.5f, 1)
                                        : glm::vec3(0.2f, 0.15f, 0.1f));
      }
    }
    return make_environment(map);
  }();
  return made;
}

void surround(Scene& scene, std::shared_ptr<const Environment> environment) {
  scene.environment = std::move(environment);
  scene.ambient = glm::vec3(0);
}

struct EnvironmentLightOf : testing::TestWithParam<const Technique*> {};

TEST_P(EnvironmentLightOf, IsThatOfForward) {
  if (GetParam()->approximate) GTEST_SKIP() << "draws another picture";
  SmallScene s = small_scene();
  for (const char* name : {"blend", "spot", "directional", "clearcoat", "occlusion_map"}) effect(name).add(s);
  const View view = small_view(47, 31);
  const Image without = render(s.scene, view, "forward");
  surround(s.scene, patched_sky());
  const Image forward = render(s.scene, view, "forward");
  ASSERT_GT(compare_images(without, forward).max_rel, 0.05);
  expect_close(s.scene, view, {}, forward, GetParam()->name, 1e-5);
}

// Every way to draw of a technique: one sample and four, and both rasterisers.
std::vector<std::string> ways_of(const Technique& technique) {
  std::vector<std::string> ways = {""};
  if (reads_setting(technique, "samples")) ways.push_back("samples=4");
  if (!reads_setting(technique, "raster")) return ways;
  for (const std::string way : std::vector(ways)) ways.push_back(way + " raster=opencl");
  return ways;
}

// Unlit surfaces of the radiance that surrounds them cannot be told from it: at edges and behind glass, too.
TEST_P(EnvironmentLightOf, IsBehindSurfacesAndBetweenThem) {
  SmallScene s = small_scene();
  effect("blend").add(s);
  s.scene.instances[0].world_from_object =
      glm::rotate(glm::scale(glm::dmat4(1), glm::dvec3(0.4)), 0.2, {0, 0, 1});
  for (Material& m : s.scene.materials) {
    m.unlit = true;
    m.base_color = glm::vec4(0.5f, 0.25f, 0.125f, m.base_color.a);
  }
  surround(s.scene, constant({0.5f, 0.25f, 0.125f}));
  for (const std::string& way : ways_of(*GetParam())) {
    const Image image = render(s.scene, small_view(47, 31), GetParam()->name, assigned(way));
    float largest = 0;
    for (const glm::vec4& pixel : image.pixels) {
      const glm::vec3 apart = glm::abs(glm::vec3(pixel) - glm::vec3(0.5f, 0.25f, 0.125f));
      largest = std::max({largest, apart.r, apart.g, apart.b});
    }
    EXPECT_LT(largest, 1e-6f) << way;
  }
}

// Pixels that see no surface, and whose neighbours see none.
std::vector<glm::ivec2> clear_pixels(const Scene& scene, const View& view) {
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward"));
  run.run_frame();
  const std::vector<float> depth = read_depth(run);
  const auto is_clear = [&](glm::ivec2 p) { return depth[size_t(p.y * view.width + p.x)] == 0; };
  std::vector<glm::ivec2> pixels;
  for (int y = 1; y + 1 < view.height; ++y) {
    for (int x = 1; x + 1 < view.width; ++x) {
      bool clear = true;
      for (int i = 0; i < 9; ++i) clear = clear && is_clear({x + i % 3 - 1, y + i / 3 - 1});
      if (clear) pixels.emplace_back(x, y);
    }
  }
  return pixels;
}

// The direction of each pixel, in the map itself. The view is turned about all axes.
TEST_P(EnvironmentLightOf, IsSeenInItsDirections) {
  static const RadianceMap map = [] {
    RadianceMap smooth{"smooth", 256, 128, {}};
    for (int row = 0; row < smooth.height; ++row) {
      for (int column = 0; column < smooth.width; ++column) {
        const glm::dvec3 d = direction_of_texel(smooth, column, row);
        smooth.texels.push_back(glm::vec3(1.5 + d.x, 1.5 + d.y, 1.5 + d.z));
      }
    }
    return smooth;
  }();
  static const std::shared_ptr<const Environment> environment = make_environment(map);
  SmallScene s = small_scene();
  s.scene.instances[0].world_from_object = glm::scale(glm::dmat4(1), glm::dvec3(0.2));
  surround(s.scene, environment);
  Camera camera = look_at({0.3, 0.2, 0.4}, {0.6, 1.2, -3});
  for (const bool orthographic : {false, true}) {
    camera.orthographic = orthographic;
    camera.far_m = 50;
    const View view = make_view(camera, 47, 31);
    const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
    const std::vector<glm::ivec2> pixels = clear_pixels(s.scene, view);
    ASSERT_GT(pixels.size(), 200u);
    for (const std::string& way : ways_of(*GetParam())) {
      const Image image = render(s.scene, view, GetParam()->name, assigned(way));
      double largest = 0;
      for (const glm::ivec2& p : pixels) {
        const glm::dvec3 to = orthographic ? glm::dvec3(0, 0, -1) : position_from_depth(view, p.x, p.y, 1);
        const glm::dvec3 expected = 1.5 + glm::normalize(world_from_view * to);
        const glm::dvec3 apart = glm::abs(glm::dvec3(image.at(p.x, p.y)) - expected);
        largest = std::max({largest, apart.r, apart.g, apart.b});
      }
      EXPECT_LT(largest, 5e-4) << way;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Techniques, EnvironmentLightOf, testing::ValuesIn(techniques()),
                         [](const auto& info) { return std::string(info.param->name); });

// Each material feature, and places that are hard: grazing views, smooth and rough surfaces, mirrored
// instances. The bounds are those of Shading in oracle_test.cpp.
struct EnvironmentInDouble : testing::TestWithParam<const char*> {};

TEST_P(EnvironmentInDouble, IsThePicture) {
  SmallScene s = small_scene();
  const std::string name = GetParam();
  Material& ball = s.scene.materials[size_t(s.ball_material)];
  if (name == "smooth") ball.roughness = 0;
  if (name == "rough") ball.roughness = 1;
  if (name == "mirrored")
    for (Instance& i : s.scene.instances)
      i.world_from_object = i.world_from_object * glm::scale(glm::dmat4(1), glm::dvec3(-1, 1.3, 0.8));
  const bool grazing = name == "grazing";
  if (!std::ranges::count(std::vector<std::string>{"smooth", "rough", "mirrored", "grazing", "lambert"},
                          name))
    effect(name).add(s);
  surround(s.scene, patched_sky());
  const View view = grazing ? make_view(look_at({2.1, 0.1, -3.97}, {-2, -0.1, -4.02}), 160, 90)
                            : make_view(look_at({0.5, 0.4, 0.3}, {0.1, -0.1, -4}), 160, 90);
  Settings settings;
  if (name == "lambert") settings.set(setting::brdf, Brdf::lambert);
  TechniqueRun forward(test_devices(), s.scene, view, settings, find_technique("forward"));
  forward.run_frame();
  const ImageError error =
      measure_reference_errors(forward.view(), forward.image(), read_depth(forward), 4000).precision;
  EXPECT_LT(error.max_rel, 2e-4);
  EXPECT_LT(error.rmse, 1e-5 * brightest_channel(forward.image()));
  EXPECT_GT(error.max_abs, 0) << "float and double agree by no accident";

  TechniqueRun visibility(test_devices(), s.scene, view, settings, find_technique("visibility"));
  visibility.run_frame();
  const std::vector<SceneTriangle> shown = shown_triangles(visibility);
  std::vector<uint32_t> covered;
  for (uint32_t i = 0; i < shown.size(); ++i)
    if (shown[i].instance >= 0) covered.push_back(i);
  const SurfacesError own =
      surfaces_error(visibility.image(), surfaces_in_double(visibility.view(), shown, covered),
                     brightest_channel(visibility.image()));
  EXPECT_GT(own.pixels, 4000u);
  EXPECT_LT(own.p99_rel, 2e-4);
  EXPECT_LT(own.rmse_rel, 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Of, EnvironmentInDouble,
                         testing::Values("smooth", "rough", "mirrored", "grazing", "lambert", "clearcoat",
                                         "clearcoat_maps", "skin", "minnaert", "specular", "normal_map",
                                         "occlusion_map", "emissive_map"),
                         [](const auto& info) { return std::string(info.param); });

// A white diffuse surface reflects pi L / pi of constant radiance L, as it does of ambient light.
TEST(EnvironmentLight, ConstantRadianceIsAmbientLightOnDiffuseSurfaces) {
  SmallScene s = small_scene();
  effect("occlusion_map").add(s);
  s.scene.background = {0.6f, 0.5f, 0.4f};
  s.scene.materials[size_t(s.wall_material)].base_color = glm::vec4(1);
  const View view = small_view(47, 31);
  const Settings lambert{{setting::brdf, Brdf::lambert}};
  for (const char* technique : {"forward", "visibility", "deferred_tiled"}) {
    s.scene.environment = nullptr;
    s.scene.ambient = {0.6f, 0.5f, 0.4f};
    const Image ambient = render(s.scene, view, technique, lambert);
    surround(s.scene, constant({0.6f, 0.5f, 0.4f}));
    EXPECT_LT(compare_images(render(s.scene, view, technique, lambert), ambient).max_rel, 2e-6);
  }
}

// The wall faces +z, so its middle mirrors the viewer's surroundings behind him.
TEST(EnvironmentLight, AMirrorShowsWhatIsBehindTheViewer) {
  SmallScene s = small_scene(false);
  s.scene.instances.resize(1);
  Material& wall = s.scene.materials[size_t(s.wall_material)];
  wall.metallic = 1;
  wall.roughness = 0;
  wall.base_color = glm::vec4(1);
  // Columns look along -x-z, +x-z, +x+z and -x+z.
  surround(s.scene, make_environment({"columns", 4, 1, {{0, 9, 0}, {0, 0, 9}, {9, 0, 0}, {9, 0, 0}}}));
  for (const char* technique : {"forward"}) {
    const glm::vec4 seen = render(s.scene, small_view(31, 31), technique).at(15, 15);
    EXPECT_NEAR(seen.r, 9, 0.05);
    EXPECT_LT(seen.g, 1e-3);
    EXPECT_LT(seen.b, 1e-3);
  }
}

TEST(EnvironmentLight, HugeRadianceLeavesFinitePictures) {
  SmallScene s = small_scene();
  for (const char* name : {"blend", "clearcoat"}) effect(name).add(s);
  surround(s.scene, constant(glm::vec3(1e30f)));
  for (const char* technique : {"forward", "visibility"})
    EXPECT_EQ(count_nan_pixels(render(s.scene, small_view(47, 31), technique)), 0u);
}

std::optional<Decision> decision_on(const Scene& scene) {
  const FramePlan plan = plan_frame(scene, small_view(17, 9), {}, find_technique("visibility").needs);
  const auto found = std::ranges::find(plan.decisions, std::string("environment light"), &Decision::effect);
  return found == plan.decisions.end() ? std::nullopt : std::optional(*found);
}

TEST(EnvironmentLight, IsPlannedWithASurfaceThatItLights) {
  SmallScene s = small_scene();
  EXPECT_FALSE(decision_on(s.scene));
  s.scene.environment = constant(glm::vec3(0.5f));
  EXPECT_TRUE(decision_on(s.scene)->needed);
  EXPECT_EQ(decision_on(s.scene)->why, "constant on material 0 \"plaster\" on node 0 \"wall\"");
  for (Material& material : s.scene.materials) material.unlit = true;
  EXPECT_TRUE(decision_on(s.scene)->needed);
  EXPECT_EQ(decision_on(s.scene)->why, "constant behind the scene");
}

// A black sky is no light, also where the effect is turned on.
TEST(EnvironmentLight, OfABlackSkyIsNothing) {
  SmallScene s = small_scene();
  s.scene.ambient = s.scene.background = glm::vec3(0);
  const View view = small_view(31, 23);
  for (const char* technique : {"forward"}) {
    s.scene.environment = nullptr;
    const Image without = render(s.scene, view, technique);
    s.scene.environment = constant(glm::vec3(0));
    EXPECT_TRUE(identical(render(s.scene, view, technique), without));
    EXPECT_TRUE(identical(render(s.scene, view, technique, {{setting::everything_on, true}}), without));
  }
}

// Another sky replaces the first one's tables; a camera that turns keeps them.
TEST(EnvironmentLight, FollowsTheCameraAndTheScene) {
  SmallScene s = small_scene();
  surround(s.scene, patched_sky());
  const View turned = make_view(look_at({0.4, 0.2, 0.5}, {0, 0, -4}), 31, 23);
  for (const char* technique : {"forward_plus", "visibility"}) {
    TechniqueRun run(test_devices(), s.scene, small_view(31, 23), {}, find_technique(technique));
    run.run_frame();
    run.view().look(turned);
    run.run_frame();
    EXPECT_TRUE(identical(run.image(), render(s.scene, turned, technique)));
  }
}

}  // namespace
}  // namespace lightgrid
