// light_prepass: its equations evaluated in double at pixels of a wall, forward's image where they are exact,
// and hard cases.
#include <cmath>
#include <functional>

#include "base/error.h"
#include "passes/common/light_buffer.h"
#include "scene/random.h"
#include "support/small_scene.h"
#include "techniques/rendering.h"

namespace lightgrid {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr PrepassSpecular variants[] = {PrepassSpecular::plain, PrepassSpecular::fifth_term,
                                        PrepassSpecular::luminance, PrepassSpecular::bent};
constexpr const char* variant_names[] = {"plain", "fifth-term", "luminance", "bent"};

Settings volumes(PrepassSpecular specular, Brdf brdf = Brdf::blinn) {
  Settings s;
  s.brdf = brdf;
  s.prepass_lights = PrepassLights::volumes;
  s.prepass_specular = specular;
  return s;
}

// The perceptual roughness whose exponent 2 / alpha^2 - 2 is n.
float roughness_of(double n) { return float(std::pow(2 / (n + 2), 0.25)); }

// A wall of one material that fills the view, and lamps whose highlights overlap on it.
Scene lit_wall(int lamps, bool white, glm::vec3 color, float metallic, double shininess) {
  Scene scene;
  scene.ambient = {0, 0, 0};
  const int material = add_material(scene, "wall", color, metallic, roughness_of(shininess));
  add_instance(scene, "wall", add_mesh(scene, wall_mesh({0, 0, -4}, 8, material, "wall")));
  constexpr glm::vec3 hues[] = {{1, 0.25f, 0.25f}, {0.25f, 1, 0.25f}, {0.25f, 0.25f, 1}};
  for (int i = 0; i < lamps; ++i) {
    const double turn = 2 * pi * i / lamps;
    const double x = 0.3 + 0.9 * std::cos(turn), y = 0.1 + 0.9 * std::sin(turn);
    add_point(scene, "lamp", {x, y, -2.8}, white ? glm::vec3(1) : hues[i % 3], 3, 6);
  }
  return scene;
}

double smooth_step(double t) { return t * t * (3 - 2 * t); }

// What the model reflects of the diffuse sums, which are the same for all channels: the article's appendix, with the
// luminance in units of `scale` for the cosine.
glm::dvec3 diffuse_by_hand(const Material& m, double n_dot_v, double luminance, double scale) {
  const double cosine = std::min(16 * luminance / scale, 1.0), roll_off = double(m.model.roll_off), k = double(m.model.minnaert_k);
  const double minnaert = std::pow(cosine, k - 1) * std::pow(std::max(n_dot_v, 1.0 / 16), 1 - k);
  const double rolled = smooth_step((cosine + roll_off) / (1 + roll_off)) - smooth_step(cosine);
  const glm::dvec3 skin = glm::dvec3(m.model.subsurface_color) * std::min(rolled / cosine, 1.0);
  return (glm::dvec3(m.base_color) * ((1 - double(m.metallic)) * 0.96 * minnaert) + skin) / pi;
}

// Equations 8.5.2 to 8.5.7 of the article with Schlick's Fresnel, as docs/techniques/light_prepass.md has
// them.
glm::dvec3 radiance_by_hand(const Scene& scene, const View& view, int x, int y, PrepassSpecular variant,
                            double scale) {
  const Material& m = scene.materials[0];
  const glm::dvec3 ndc(2 * (x + 0.5) / view.width - 1, 2 * (y + 0.5) / view.height - 1, 0);
  const glm::dvec3 p =
      4.0 * glm::dvec3(ndc.x / view.clip_from_view[0][0], ndc.y / view.clip_from_view[1][1], -1);
  const glm::dvec3 normal(0, 0, 1), viewer = -glm::normalize(p), color(m.base_color);
  constexpr double n = 32;
  glm::dvec3 diffuse(0);
  double specular = 0, fifth = 0, rim = 0;
  for (const Light& light : scene.lights) {
    const glm::dvec3 to_light = light.position - p;
    const double distance = glm::length(to_light), ratio = distance / double(light.radius_m);
    const double attenuation = std::max(1 - std::pow(ratio, 4), 0.0) / (distance * distance);
    const glm::dvec3 l = to_light / distance, h = glm::normalize(l + viewer);
    const double arriving = std::max(glm::dot(normal, l), 0.0) * attenuation;
    const double schlick = std::pow(1 - glm::dot(viewer, h), 5), lobe = std::pow(glm::dot(normal, h), n);
    const glm::dvec3 intensity = glm::dvec3(light.color) * double(light.intensity);
    const double brightest = std::max({intensity.r, intensity.g, intensity.b});
    diffuse += arriving * (1 - schlick) * intensity;
    specular += arriving * lobe * brightest;
    fifth += arriving * brightest;
    rim += arriving * lobe * schlick * brightest;
  }
  const double alpha = double(m.roughness) * double(m.roughness), shininess = 2 / (alpha * alpha) - 2,
               power = shininess / n;
  const double luminance = 0.2126 * diffuse.r + 0.7152 * diffuse.g + 0.0722 * diffuse.b;
  double highlight = 0, share = std::pow(1 - glm::dot(normal, viewer), 5), exponent = shininess;
  switch (variant) {
    case PrepassSpecular::plain:
      highlight = specular, exponent = n;
      break;
    case PrepassSpecular::fifth_term:
      highlight = fifth * std::pow(specular / fifth, power), share = rim / specular;
      break;
    case PrepassSpecular::luminance:
      highlight = luminance * std::pow(std::min(specular / luminance, 1.0), power);
      break;
    case PrepassSpecular::bent:
      highlight = scale * std::pow(std::min(specular / scale, 1.0), power);
      break;
  }
  highlight *= (exponent + 2) / (8 * pi);
  const glm::dvec3 f0 = glm::mix(glm::dvec3(0.04), color, double(m.metallic));
  const glm::dvec3 reflected = diffuse_by_hand(m, glm::dot(normal, viewer), luminance, scale);
  return reflected * diffuse + highlight * (f0 * (1 - share) + share);
}

double error_by_hand(const Scene& scene, const View& view, const Image& image, PrepassSpecular variant) {
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.light_grid = true}));
  double most = 0, brightest = 0;
  for (int y = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x) {
      const glm::dvec3 expected = radiance_by_hand(scene, view, x, y, variant, scale);
      const glm::dvec3 drawn(glm::vec3(image.at(x, y)));
      for (int c = 0; c < 3; ++c) {
        most = std::max(most, std::abs(drawn[c] - expected[c]));
        brightest = std::max(brightest, expected[c]);
      }
    }
  }
  return most / brightest;
}

// A light and a material of the same shininess: the equations are Blinn-Phong's. The fifth term comes with
// the sum of Schlick's terms, so that it is exact for every material; the others where Fresnel is constant: a
// white metal.
TEST(LightPrepass, IsForwardsImageOfOneLightAndItsShininess) {
  const View view = small_view(63, 37);
  for (const bool white : {true, false}) {
    for (size_t i = 0; i < std::size(variants); ++i) {
      const bool fifth = variants[i] == PrepassSpecular::fifth_term;
      const auto error_on = [&](glm::vec3 color, float metallic, int lamps = 1) {
        const Scene scene = lit_wall(lamps, white, color, metallic, 32);
        const Image forward = render(scene, view, "forward", {.brdf = Brdf::blinn});
        return compare_images(render(scene, view, "light_prepass", volumes(variants[i])), forward).max_rel;
      };
      if (!white) {
        EXPECT_GT(error_on({1, 1, 1}, 1), 0.01) << "a highlight has no colour: " << variant_names[i];
        continue;
      }
      EXPECT_LT(error_on({1, 1, 1}, 1), 1e-5) << variant_names[i];
      if (fifth) {
        EXPECT_LT(error_on({0.9f, 0.6f, 0.3f}, 0.3f), 1e-5);
        EXPECT_LT(error_on({0.9f, 0.6f, 0.3f}, 0.3f, 3), 1e-5) << "any number of white lights";
      }
    }
  }
}

// The table of docs/techniques/light_prepass.md#errors is printed.
TEST(LightPrepass, IsItsEquationsForAnyNumberOfLights) {
  const View view = small_view(63, 37);
  fmt::print("lights  colours  variant     rmse of forward's brightest channel\n");
  for (const int lamps : {1, 2, 4, 8}) {
    for (const bool white : {true, false}) {
      const Scene scene = lit_wall(lamps, white, {0.8f, 0.7f, 0.6f}, 0.5f, 200);
      const Image forward = render(scene, view, "forward", {.brdf = Brdf::blinn});
      for (size_t i = 0; i < std::size(variants); ++i) {
        const Image image = render(scene, view, "light_prepass", volumes(variants[i]));
        EXPECT_LT(error_by_hand(scene, view, image, variants[i]), 2e-5)
            << variant_names[i] << ' ' << lamps << ' ' << white;
        fmt::print("{:6}  {:7}  {:10}  {:.2e}\n", lamps, white ? "white" : "hues", variant_names[i],
                   compare_images(image, forward).rmse / brightest_channel(forward));
      }
    }
  }
}

// Skin and Minnaert take the luminance of the sums for the cosine. Where no light arrives nothing glows.
TEST(LightPrepass, GivesModelsTheLuminanceOfTheSums) {
  const View view = small_view(63, 37);
  constexpr MaterialModel models[] = {{.subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f},
                                      {.minnaert_k = 1.5f},
                                      {.subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f, .minnaert_k = 0.6f}};
  for (const MaterialModel& model : models) {
    Scene scene = lit_wall(2, false, {0.8f, 0.7f, 0.6f}, 0.5f, 200);
    scene.materials[0].model = model;
    const Image image = render(scene, view, "light_prepass", volumes(PrepassSpecular::luminance));
    EXPECT_LT(error_by_hand(scene, view, image, PrepassSpecular::luminance), 2e-5) << model.roll_off << ' ' << model.minnaert_k;
    for (Light& light : scene.lights) light.position.z -= 50;
    EXPECT_EQ(brightest_channel(render(scene, view, "light_prepass", volumes(PrepassSpecular::luminance))), 0);
  }
}

// Without a specular term nothing is approximated.
TEST(LightPrepass, OfLambertIsForwardsImage) {
  const Scene scene = find_builtin_scene("street")->make();
  const View view = default_view(scene, 79, 45);
  const Image forward = render(scene, view, "forward", {.brdf = Brdf::lambert});
  for (const VolumeCulling culling : {VolumeCulling::back_faces, VolumeCulling::stencil,
                                      VolumeCulling::scissor, VolumeCulling::depth_bounds}) {
    Settings settings = volumes(PrepassSpecular::plain, Brdf::lambert);
    settings.volume_culling = culling;
    expect_close(scene, view, settings, forward, "light_prepass");
  }
}

TEST(LightPrepass, OfLambertIsForwardsImageWithEveryEffect) {
  const View view = small_view(47, 31);
  for (const Effect& effect : effects()) {
    SCOPED_TRACE(effect.name);
    SmallScene s = small_scene();
    effect.add(s);
    if (effect.name == "skin" || effect.name == "minnaert") continue;  // models of each light: approximate
    const Image forward = render(s.scene, view, "forward", {.brdf = Brdf::lambert});
    expect_close(s.scene, view, volumes(PrepassSpecular::plain, Brdf::lambert), forward, "light_prepass");
  }
}

// Rounding of sums in 8 and 16 bits: each light's half step of 1/255 of the scale, or half unit in the last
// of 11 places.
TEST(LightPrepass, RoundsSumsByTheStepsOfItsBits) {
  constexpr int lamps = 4;
  const Scene scene = lit_wall(lamps, false, {1, 1, 1}, 0, 200);
  const View view = small_view(63, 37);
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.light_grid = true}));
  EXPECT_EQ(scale, 8) << "3 cd at 6 m / 8: 5.3 lx";
  Settings settings = volumes(PrepassSpecular::plain, Brdf::lambert);
  const Image exact = render(scene, view, "light_prepass", settings);
  const double brightest = brightest_channel(exact);
  ASSERT_LT(brightest, scale / pi) << "nothing is cut off";
  for (const auto& [bits, step] : {std::pair(8, scale / 255 / pi), {16, brightest * 0x1p-10}}) {
    settings.buffer_bits = bits;
    const double error = compare_images(render(scene, view, "light_prepass", settings), exact).max_abs;
    EXPECT_LE(error, lamps * 0.5 * step + 1e-6) << bits;
    EXPECT_GE(error, 0.25 * step) << bits;
  }
}

Settings tiles() {
  Settings s = volumes(PrepassSpecular::fifth_term);
  s.prepass_lights = PrepassLights::tiles;
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
    settings.kernel_shape = KernelShape::group;
    if (size.x > 1) expect_close(scene, view, settings, by_volumes, "light_prepass");
  }
}

// Once, where the sum is stored: half a step, and what 0.004 degrees of the normal change.
TEST(LightPrepass, RoundsSumsOfListsOnce) {
  const Scene scene = with_effects({"normal_map", "spot"});
  const View view = small_view(71, 37);
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.light_grid = true}));
  const Image exact = render(scene, view, "light_prepass", volumes(PrepassSpecular::plain, Brdf::lambert));
  Settings settings{.brdf = Brdf::lambert, .buffer_bits = 8, .normals = NormalFormat::octahedral};
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
  settings.raster = RasterApi::opencl;
  expect_close(scene, view, settings, with_gl, "light_prepass");
  EXPECT_LT(distance_of(render(scene, view, "light_prepass", settings), with_gl).median, 1e-5);
  settings.prepass_lights = PrepassLights::volumes;
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
    stencil.volume_culling = VolumeCulling::stencil;
    expect_close(s.scene, view, stencil, render(s.scene, view, "light_prepass", tiles()), "light_prepass");
    expect_close(s.scene, view, tiles(), render(s.scene, view, "light_prepass", stencil), "light_prepass");
    for (const PrepassSpecular specular : variants) {
      for (const int bits : hard.in_all_formats ? std::vector{8, 16} : std::vector<int>()) {
        Settings settings = volumes(specular);
        settings.buffer_bits = bits, settings.normals = NormalFormat::xyz8;
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
  const size_t pixels = 64 * 40, lights = 7 * 48;
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
      settings.buffer_bits = bits, settings.normals = format;
      EXPECT_EQ(result_of("light_prepass", settings).memory_gbuffer, pixels * (normal + sums));
      EXPECT_EQ(result_of("light_prepass", settings).memory_total,
                scene_bytes + pixels * (normal + sums + 16 + 4));
      settings.prepass_specular = PrepassSpecular::fifth_term;
      EXPECT_EQ(result_of("light_prepass", settings).memory_gbuffer, pixels * (normal + sums + sums / 2));
    }
  }
  const RunResult of_tiles = result_of("light_prepass", tiles());
  EXPECT_EQ(of_tiles.memory_gbuffer, pixels * 40);
  EXPECT_EQ(of_tiles.memory_total - result_of("forward_plus", {}).memory_total,
            pixels * 40 + (pixels + 16) * 40 + lights + sizeof(ViewParams));
}

// Also the code of skin and Minnaert, which no surface here has.
TEST(LightPrepass, EverythingOnChangesNoByte) {
  const Scene scene = small_scene().scene;
  const View view = small_view(33, 19);
  EXPECT_TRUE(identical(render(scene, view, "light_prepass", {.everything_on = true}), render(scene, view, "light_prepass")));
}

}  // namespace
}  // namespace lightgrid
