// The shaders against the oracle in double, pixel by pixel.
#include "accuracy/oracle_sample.h"
#include "plan/settings/model.h"
#include "report/report.h"
#include "scene/random.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
using namespace lab;
namespace {

struct Shading : testing::TestWithParam<const char*> {};

// Each light's term has about 50 roundings of 2^-24, and a sum of n of them at most n more: with at most 100
// lights at a pixel, 1e-5 of the value. A highlight's peak multiplies the rounding of its angles by up to 2 /
// alpha, 20 for the polished materials of these scenes: 2e-4 of the brightest channel. Measured (llvmpipe):
// 2e-6 to 2e-5 at worst, 2e-7 root mean square.
TEST_P(Shading, InFloatIsTheOraclesWithinItsRounding) {
  const Scene scene = find_builtin_scene(GetParam())->make();
  const View view = default_view(scene, 320, 180);
  TechniqueRun run(test_devices(), scene, view, {}, find_technique("forward"));
  run.run_frame();
  const auto depth = read_depth(run);
  const ReferenceErrors errors = measure_reference_errors(run.view(), run.image(), depth, 4000);
  const float brightest = brightest_channel(run.image());
  RecordProperty("max_rel", fmt::format("{}", errors.precision.max_rel));
  EXPECT_LT(errors.precision.max_rel, 2e-4);
  EXPECT_LT(errors.precision.rmse, 1e-6 * brightest);
  EXPECT_GT(errors.precision.max_abs, 0) << "float and double agree by no accident";
  EXPECT_GT(errors.model.max_abs, 0) << "the window takes light away";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Shading,
                         testing::Values("hall", "spheres", "terrain", "street", "gallery", "rooms"),
                         [](const auto& info) { return std::string(info.param); });

// No peak multiplies a rounding. A position is rounded to 1e-7 of its distance from the eye, which is up to
// some hundred times its distance from a lamp: 2 * 100 * 1e-7. Measured: 2.4e-5.
TEST(LambertShading, InFloatIsTheOraclesWithinItsRounding) {
  const Scene scene = find_builtin_scene("spheres")->make();
  TechniqueRun run(test_devices(), scene, default_view(scene, 160, 90), {{setting::brdf, Brdf::lambert}},
                   find_technique("forward"));
  run.run_frame();
  const ReferenceErrors errors = measure_reference_errors(run.view(), run.image(), read_depth(run), 4000);
  EXPECT_LT(errors.precision.max_rel, 5e-5);
  EXPECT_GT(errors.precision.max_abs, 0) << "float and double agree by no accident";
}

// Every technique against the oracle, at a sample of pixels and where it differs most
// from forward: as exact as forward.
void expect_each_exact(const Scene& scene, const View& view, const Settings& settings = {}) {
  TechniqueRun forward(test_devices(), scene, view, settings, find_technique("forward"));
  forward.run_frame();
  const auto depth = read_depth(forward);
  const SurfaceOracle oracle(forward.view(), depth);
  const std::vector<uint32_t> sample = sample_pixels(oracle.pixels(), 4000);
  for (const Technique* technique : techniques()) {
    // lidr stores at most 16 lights a pixel and omits others: lidr_test.
    if (technique->name == std::string("forward") || technique->name == std::string("lidr")) continue;
    if (technique->approximate) continue;
    if (own_surfaces(*technique, settings)) continue;  // against surfaces in double: passes/resolve_test
    SCOPED_TRACE(technique->name);
    const Image image = render(scene, view, technique->name, settings);
    std::vector<uint32_t> pixels = most_different(image, forward.image(), oracle.pixels(), 200);
    pixels.insert(pixels.end(), sample.begin(), sample.end());
    ImageError error = compare_images(image, forward.image());
    error.oracle = oracle_error(image, forward.image(), pixels, oracle.shade(pixels, true));
    fmt::print("{:<22} max_rel {:.2e}, of oracle {:.2e}, forward {:.2e}, ratio {:.2f}\n", technique->name,
               error.max_rel, error.oracle->max_rel, error.oracle->of_reference_max_rel,
               error.oracle->max_rel / error.oracle->of_reference_max_rel);
    EXPECT_TRUE(is_exact(error)) << fmt::format(
        "off the oracle by {:.2e}, forward by {:.2e}; apart by {:.2e}", error.oracle->max_rel,
        error.oracle->of_reference_max_rel, error.max_rel);
  }
}

TEST_P(Shading, OfEveryTechniqueIsAsExactAsForwards) {
  const Scene scene = find_builtin_scene(GetParam())->make();
  expect_each_exact(scene, default_view(scene, 160, 90));
}

// Balls of polished metal among strong lamps, `scale` metres large: highlights that
// multiply each rounding by 2 / alpha.
Scene polished(double scale, float roughness, float intensity) {
  Scene scene;
  scene.ambient = glm::vec3(0.01f);
  const int metal = add_material(scene, "polished", {0.95f, 0.93f, 0.88f}, 1, roughness);
  const int paint = add_material(scene, "lacquer", {0.5f, 0.05f, 0.04f}, 0.3f, roughness);
  for (const int material : {metal, paint}) {
    Mesh ball;
    shapes::add_sphere(ball, {0, 0, 0}, 1, 24);
    const int mesh = add_mesh(scene, shapes::finished(std::move(ball), "ball", material));
    for (int i = 0; i < 3; ++i) {
      glm::dmat4 matrix(scale * 0.9);
      matrix[3] =
          glm::dvec4(glm::dvec3(2.1 * i - 2.1, material == metal ? 1.1 : -1.1, -5 - 0.4 * i) * scale, 1);
      add_instance(scene, "ball", mesh, matrix);
    }
  }
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 at{random.uniform(-5, 5), random.uniform(-4, 4), random.uniform(-5, 1)};
    add_point(scene, "lamp", at * float(scale), {1, random.uniform(0.4f, 1), random.uniform(0.4f, 1)},
              intensity * float(scale * scale), float(scale) * random.uniform(2, 9));
  }
  return scene;
}

View view_at(double scale, int width, int height) {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  camera.near_m = 0.01 * scale;
  return make_view(camera, width, height);
}

struct Polished : testing::TestWithParam<std::tuple<double, float, float>> {};

TEST_P(Polished, EveryTechniqueIsAsExactAsForward) {
  const auto [scale, roughness, intensity] = GetParam();
  expect_each_exact(polished(scale, roughness, intensity), view_at(scale, 192, 108));
}

INSTANTIATE_TEST_SUITE_P(Scales, Polished,
                         testing::Combine(testing::Values(1e-3, 1.0, 1e4), testing::Values(0.0f, 0.1f),
                                          testing::Values(1.0f, 1000.0f)),
                         [](const auto& info) {
                           return fmt::format("{}mRoughness{}Intensity{}",
                                              std::get<0>(info.param) < 1   ? "1m"
                                              : std::get<0>(info.param) > 1 ? "10k"
                                                                            : "1",
                                              std::get<1>(info.param) > 0 ? "01" : "0",
                                              int(std::get<2>(info.param)));
                         });

// All of them lacquered, so that highlights of two widths lie over each other; under
// half of the coats a normal map.
Scene polished_and_coated() {
  Scene scene = polished(1, 0.4f, 10);
  for (Material& m : scene.materials) {
    m.clearcoat = 1;
    m.clearcoat_roughness = 0.1f;
  }
  scene.materials[1].normal_map.texture = add_speckles(scene, false);
  scene.materials[1].normal_scale = 0.3f;
  return scene;
}

TEST(PolishedUnderCoats, EveryTechniqueIsAsExactAsForward) {
  expect_each_exact(polished_and_coated(), view_at(1, 192, 108));
}

// Forward's picture is the oracle's, and the part of the materials that `plain` takes away is seen.
void expect_float_is_the_oracles(const Scene& scene, const View& view, const Settings& settings,
                                 void (*plain)(Material&)) {
  TechniqueRun run(test_devices(), scene, view, settings, find_technique("forward"));
  run.run_frame();
  EXPECT_EQ(count_nan_pixels(run.image()), 0u);
  const ReferenceErrors errors = measure_reference_errors(run.view(), run.image(), read_depth(run), 4000);
  EXPECT_LT(errors.precision.max_rel, 2e-4);  // as of every scene
  EXPECT_GT(errors.precision.max_abs, 0) << "float and double agree by no accident";
  Scene bare = scene;
  std::ranges::for_each(bare.materials, plain);
  EXPECT_GT(compare_images(run.image(), render(bare, view, "forward", settings)).max_rel, 0.1);
}

void without_coat(Material& m) { m.clearcoat = 0; }

TEST(CoatShading, InFloatIsTheOraclesWithinItsRounding) {
  expect_float_is_the_oracles(polished_and_coated(), view_at(1, 192, 108), {}, without_coat);
}

// A coat whose map is black is compiled and sampled, and changes no bit.
TEST(CoatShading, ABlackMapIsNoCoat) {
  Scene scene = polished_and_coated();
  const View view = view_at(1, 95, 53);
  scene.textures.push_back({.bitmap = int(scene.bitmaps.size())});
  scene.bitmaps.push_back({.name = "black", .width = 1, .height = 1, .rgba = {0, 0, 0, 255}});
  Scene bare = scene;
  for (Material& m : scene.materials) m.clearcoat_map.texture = int(scene.textures.size()) - 1;
  std::ranges::for_each(bare.materials, without_coat);
  for (const char* technique : {"forward", "forward_plus", "deferred", "visibility"}) {
    const Image image = render(scene, view, technique);
    EXPECT_TRUE(identical(image, render(bare, view, technique))) << technique;
  }
}

TEST(CoatShading, LambertHasNone) {
  const Scene scene = polished_and_coated();
  Scene bare = scene;
  std::ranges::for_each(bare.materials, without_coat);
  const View view = view_at(1, 95, 53);
  EXPECT_TRUE(identical(render(scene, view, "forward", {{setting::brdf, Brdf::lambert}}),
                        render(bare, view, "forward", {{setting::brdf, Brdf::lambert}})));
}

TEST(PolishedBlinnPhong, EveryTechniqueIsAsExactAsForward) {
  expect_each_exact(polished(1, 0.1f, 10), view_at(1, 192, 108), {{setting::brdf, Brdf::blinn}});
}

void add_lamps(Scene& scene, float lowest_z) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const glm::vec3 at{random.uniform(-5, 5), random.uniform(-4, 4), random.uniform(lowest_z, -2)};
    add_point(scene, "lamp", at, {1, random.uniform(0.4f, 1), random.uniform(0.4f, 1)}, 1,
              random.uniform(3, 7));
  }
}

// Skin, Minnaert's of k below and above 1, one under a coat, and Lambert's.
Scene balls_of_all_models() {
  Scene scene;
  scene.ambient = glm::vec3(0.05f);
  Mesh ball;
  shapes::add_sphere(ball, {0, 0, 0}, 1, 16);
  const MaterialModel models[] = {{},
                                  {.subsurface_color = {1, 0.2f, 0.2f}, .roll_off = 0.4f},
                                  {.minnaert_k = 0.5f},
                                  {.minnaert_k = 1.6f},
                                  {.subsurface_color = {0.2f, 0.6f, 0.3f}, .roll_off = 0.9f}};
  for (int i = 0; i < 5; ++i) {
    const int material = add_material(scene, "ball", {0.7f, 0.6f, 0.5f}, 0.1f, 0.5f);
    scene.materials[size_t(material)].model = models[i];
    if (i == 4) {
      scene.materials[size_t(material)].clearcoat = 1;
      scene.materials[size_t(material)].clearcoat_roughness = 0.3f;
    }
    add_instance(scene, "ball", add_mesh(scene, shapes::finished(ball, "ball", material)),
                 placed({2.1 * i - 4.2, i % 2 ? 0.8 : -0.8, -7 - 0.4 * i}));
  }
  add_lamps(scene, -5);  // in front
  return scene;
}

TEST(ModelShading, InFloatIsTheOraclesWithinItsRounding) {
  expect_float_is_the_oracles(balls_of_all_models(), view_at(1, 160, 90), {},
                              [](Material& m) { m.model = {}; });
}

// KHR_materials_ior and KHR_materials_specular: no, little, usual, much and total reflection; weakened,
// coloured, half metal, of a map, and under a coat.
Scene balls_of_all_reflectances() {
  Scene scene;
  scene.ambient = glm::vec3(0.05f);
  Mesh ball;
  shapes::add_sphere(ball, {0, 0, 0}, 1, 16);
  const float iors[] = {1.5f, 1, 1.33f, 2.42f, 0, 1.5f, 3, 2.42f, 1.5f, 1.33f};
  for (int i = 0; i < 10; ++i) {
    const int material =
        add_material(scene, "ball", {0.7f, 0.6f, 0.5f}, i == 7 ? 0.5f : 0, i % 2 ? 0.5f : 0.25f);
    Material& m = scene.materials[size_t(material)];
    m.ior = iors[i];
    if (i == 5) m.specular = 0;
    if (i == 6) {
      m.specular = 0.6f;
      m.specular_color = {8, 2, 0.5f};
    }
    if (i == 7) m.specular_color = {1, 0.5f, 0};
    if (i == 8) m.specular_map.texture = m.specular_color_map.texture = add_speckles(scene, false);
    if (i == 9) {
      m.clearcoat = 0.7f;
      m.clearcoat_roughness = 0.3f;
    }
    add_instance(scene, "ball", add_mesh(scene, shapes::finished(ball, "ball", material)),
                 placed({2.1 * (i % 5) - 4.2, i < 5 ? 1.1 : -1.1, -7 - 0.2 * i}));
  }
  add_lamps(scene, -9);
  return scene;
}

TEST(SpecularShading, EveryTechniqueIsAsExactAsForward) {
  expect_each_exact(balls_of_all_reflectances(), view_at(1, 192, 108));
}

void without_reflectance(Material& m) {
  m.ior = 1.5f;
  m.specular = 1;
  m.specular_color = {1, 1, 1};
  m.specular_map = m.specular_color_map = {};
}

TEST(SpecularShading, InFloatIsTheOraclesWithinItsRounding) {
  for (const Brdf brdf : {Brdf::ggx, Brdf::blinn})
    expect_float_is_the_oracles(balls_of_all_reflectances(), view_at(1, 192, 108), {{setting::brdf, brdf}},
                                without_reflectance);
}

TEST(SpecularShading, LambertHasNone) {
  const Scene scene = balls_of_all_reflectances();
  Scene bare = scene;
  std::ranges::for_each(bare.materials, without_reflectance);
  const View view = view_at(1, 95, 53);
  for (const char* technique : {"forward", "deferred_tiled", "visibility"})
    EXPECT_TRUE(identical(render(scene, view, technique, {{setting::brdf, Brdf::lambert}}),
                          render(bare, view, technique, {{setting::brdf, Brdf::lambert}})))
        << technique;
}

// A ball beside the wall has another reflectance, and the wall's pixels, far from it, the bits of a scene
// without.
TEST(SpecularShading, ChangesNoBitOfASurfaceOfTheDefaultReflectance) {
  SmallScene s = small_scene();
  s.scene.materials[s.ball_material].metallic = 0.5f;
  s.scene.materials[s.wall_material].metallic = 0.3f;
  SmallScene other = s;
  other.scene.materials[s.ball_material].ior = 2.42f;
  const View view = small_view(64, 36);
  for (const char* technique : {"forward", "deferred", "deferred_tiled", "forward_plus_compute",
                                "light_prepass", "visibility", "voxel_lights"}) {
    const Image plain = render(s.scene, view, technique), changed = render(other.scene, view, technique);
    size_t ball = 0;
    for (int y = 0; y < 36; ++y) {
      for (int x = 0; x < 64; ++x) {
        if (x < 24)
          EXPECT_EQ(plain.at(x, y), changed.at(x, y)) << technique << ' ' << x << ' ' << y;
        else
          ball += plain.at(x, y) != changed.at(x, y);
      }
    }
    EXPECT_GT(ball, 50u) << technique;
  }
}

// Models without a lobe, which GGX does not reach. Only in OpenGL; gallery has the kernels.
TEST(ModelShading, WithLambertIsTheOraclesInTheShadersOfForwardAndDeferred) {
  const Scene scene = balls_of_all_models();
  const View view = view_at(1, 160, 90);
  TechniqueRun run(test_devices(), scene, view, {{setting::brdf, Brdf::lambert}}, find_technique("forward"));
  run.run_frame();
  EXPECT_LT(measure_reference_errors(run.view(), run.image(), read_depth(run), 4000).precision.max_rel, 5e-5);
  EXPECT_LT(
      compare_images(run.image(), render(scene, view, "deferred", {{setting::brdf, Brdf::lambert}})).max_rel,
      1e-5);
}

}  // namespace
}  // namespace lightgrid
