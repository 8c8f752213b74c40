// light_prepass: its equations evaluated in double at pixels of a wall, and forward's image where they are
// exact.
#include "passes/common/prepass_settings.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "techniques/light_prepass_by_hand.h"

namespace lightgrid {
namespace {

using namespace light_prepass_by_hand;

// A light and a material of the same shininess: the equations are Blinn-Phong's. The fifth term comes with
// the sum of Schlick's terms, so that it is exact for every material; the others where Fresnel is constant: a
// white metal.
TEST(LightPrepass, IsForwardsImageOfOneLightAndItsShininess) {
  const View view = small_view(63, 37);
  for (const bool white : {true, false}) {
    for (size_t i = 0; i < std::size(variants); ++i) {
      const bool fifth = variants[i] == PrepassSpecular::fifth_term;
      const auto error_on = [&](glm::vec3 color, float metallic, int lamps = 1, double shininess = 32) {
        const Scene scene = lit_wall(lamps, white, color, metallic, shininess);
        const Image forward = render(scene, view, "forward", {{setting::brdf, Brdf::blinn}});
        return compare_images(render(scene, view, "light_prepass", volumes(variants[i])), forward).max_rel;
      };
      if (!white) {
        EXPECT_GT(error_on({1, 1, 1}, 1), 0.01) << "a highlight has no colour: " << variant_names[i];
        continue;
      }
      EXPECT_LT(error_on({1, 1, 1}, 1), 1e-5) << variant_names[i];
      if (variants[i] == PrepassSpecular::stored) {
        EXPECT_LT(error_on({1, 1, 1}, 1, 3, 200), 1e-5) << "any number of white lights, any shininess";
      }
      if (fifth) {
        EXPECT_LT(error_on({0.9f, 0.6f, 0.3f}, 0.3f), 1e-5);
        EXPECT_LT(error_on({0.9f, 0.6f, 0.3f}, 0.3f, 3), 1e-5) << "any number of white lights";
      }
    }
  }
}

// The table of docs/details/light_prepass.md#errors-of-the-highlights is printed.
TEST(LightPrepass, IsItsEquationsForAnyNumberOfLights) {
  const View view = small_view(63, 37);
  fmt::print("lights  colours  variant     rmse of forward's brightest channel\n");
  for (const int lamps : {1, 2, 4, 8}) {
    for (const bool white : {true, false}) {
      const Scene scene = lit_wall(lamps, white, {0.8f, 0.7f, 0.6f}, 0.5f, 200);
      const Image forward = render(scene, view, "forward", {{setting::brdf, Brdf::blinn}});
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

// Specular reflectance: of the sums' (1 - g), also the diffuse light that no reflection takes away.
TEST(LightPrepass, GivesMaterialsTheirSpecularReflectance) {
  const View view = small_view(63, 37);
  Scene scene = lit_wall(3, false, {0.8f, 0.7f, 0.6f}, 0.25f, 200);
  Material& m = scene.materials[0];
  m.ior = 2.42f;
  m.specular = 0.5f;
  m.specular_color = {2, 7, 1};
  for (size_t i = 0; i < std::size(variants); ++i) {
    const Image image = render(scene, view, "light_prepass", volumes(variants[i]));
    EXPECT_LT(error_by_hand(scene, view, image, variants[i]), 2e-5) << variant_names[i];
  }
  // Whole reflectance and one white light: exact, as of other materials.
  scene = lit_wall(1, true, {0.8f, 0.7f, 0.6f}, 0.25f, 200);
  scene.materials[0].ior = 2.42f;
  EXPECT_LT(compare_images(render(scene, view, "light_prepass", volumes(PrepassSpecular::fifth_term)),
                           render(scene, view, "forward", {{setting::brdf, Brdf::blinn}}))
                .max_rel,
            1e-5);
}

// Skin and Minnaert take the luminance of the sums for the cosine. Where no light arrives nothing glows.
TEST(LightPrepass, GivesModelsTheLuminanceOfTheSums) {
  const View view = small_view(63, 37);
  constexpr MaterialModel models[] = {
      {.subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f},
      {.minnaert_k = 1.5f},
      {.subsurface_color = {0.9f, 0.3f, 0.2f}, .roll_off = 0.4f, .minnaert_k = 0.6f}};
  for (const MaterialModel& model : models) {
    Scene scene = lit_wall(2, false, {0.8f, 0.7f, 0.6f}, 0.5f, 200);
    scene.materials[0].model = model;
    const Image image = render(scene, view, "light_prepass", volumes(PrepassSpecular::luminance));
    EXPECT_LT(error_by_hand(scene, view, image, PrepassSpecular::luminance), 2e-5)
        << model.roll_off << ' ' << model.minnaert_k;
    for (Light& light : scene.lights) light.position.z -= 50;
    EXPECT_EQ(brightest_channel(render(scene, view, "light_prepass", volumes(PrepassSpecular::luminance))),
              0);
  }
}

// Without a specular term nothing is approximated.
TEST(LightPrepass, OfLambertIsForwardsImage) {
  const Scene scene = find_builtin_scene("street")->make();
  const View view = default_view(scene, 79, 45);
  const Image forward = render(scene, view, "forward", {{setting::brdf, Brdf::lambert}});
  for (const VolumeCulling culling : {VolumeCulling::back_faces, VolumeCulling::stencil,
                                      VolumeCulling::scissor, VolumeCulling::depth_bounds}) {
    Settings settings = volumes(PrepassSpecular::plain, Brdf::lambert);
    settings.set(setting::volume_culling, culling);
    expect_close(scene, view, settings, forward, "light_prepass");
  }
}

TEST(LightPrepass, OfLambertIsForwardsImageWithEveryEffect) {
  const View view = small_view(47, 31);
  for (const SceneEffect& effect : effects()) {
    SCOPED_TRACE(effect.name);
    SmallScene s = small_scene();
    effect.add(s);
    if (effect.name == "skin" || effect.name == "minnaert") continue;  // models of each light: approximate
    const Image forward = render(s.scene, view, "forward", {{setting::brdf, Brdf::lambert}});
    expect_close(s.scene, view, volumes(PrepassSpecular::plain, Brdf::lambert), forward, "light_prepass");
  }
}

// Rounding of sums in 8 and 16 bits: each light's half step of 1/255 of the scale, or half unit in the last
// of 11 places.
TEST(LightPrepass, RoundsSumsByTheStepsOfItsBits) {
  constexpr int lamps = 4;
  const Scene scene = lit_wall(lamps, false, {1, 1, 1}, 0, 200);
  const View view = small_view(63, 37);
  const double scale = reference_light(scene, plan_frame(scene, view, {}, {.lists = {.light_grid = true}}));
  EXPECT_EQ(scale, 8) << "3 cd at 6 m / 8: 5.3 lx";
  Settings settings = volumes(PrepassSpecular::plain, Brdf::lambert);
  const Image exact = render(scene, view, "light_prepass", settings);
  const double brightest = brightest_channel(exact);
  ASSERT_LT(brightest, scale / pi) << "nothing is cut off";
  for (const auto& [bits, step] : {std::pair(8, scale / 255 / pi), {16, brightest * 0x1p-10}}) {
    settings.set(setting::buffer_bits, bits);
    const double error = compare_images(render(scene, view, "light_prepass", settings), exact).max_abs;
    EXPECT_LE(error, lamps * 0.5 * step + 1e-6) << bits;
    EXPECT_GE(error, 0.25 * step) << bits;
  }
}

}  // namespace
}  // namespace lightgrid
