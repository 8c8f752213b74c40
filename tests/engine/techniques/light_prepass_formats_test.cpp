// light_prepass: roughness next to normals, and the light buffer as hue and luminance.
#include "base/error.h"
#include "passes/common/prepass_settings.h"
#include "plan/settings/surfaces.h"
#include "shared/light_luv.h"
#include "techniques/light_prepass_by_hand.h"

namespace lightgrid {
namespace {

using namespace light_prepass_by_hand;

// Different roughnesses on the wall, a coat on the ball.
Scene rough_and_coated() {
  SmallScene s = small_scene();
  for (const char* name : {"metallic_roughness_map", "clearcoat", "spot"}) effect(name).add(s);
  return s.scene;
}

TEST(LightPrepassFormats, RoughnessNextToNormalsIsTheSameInOpenGlAndOpenCl) {
  const Scene scene = rough_and_coated();
  const View view = small_view(71, 37);
  for (const NormalFormat format : {NormalFormat::floats, NormalFormat::xyz8}) {
    Settings settings = volumes(PrepassSpecular::stored);
    settings.set(setting::normals, format);
    const Image by_volumes = render(scene, view, "light_prepass", settings);
    apply_setting(settings, "prepass-lights=tiles");
    // The coat's exponent, 4,000, raises the rounding of sums.
    expect_close(scene, view, settings, by_volumes, "light_prepass", 3e-5);
    settings.set(setting::raster, RasterApi::opencl);
    EXPECT_LT(distance_of(render(scene, view, "light_prepass", settings), by_volumes).median, 1e-5);
    apply_setting(settings, "kernel-shape=group");
    EXPECT_LT(distance_of(render(scene, view, "light_prepass", settings), by_volumes).median, 1e-5);
  }
}

// A highlight's exponent changes by at most 4 / 255 / roughness of itself per half step.
TEST(LightPrepassFormats, RoughnessIn8BitsIsNearTheExactOne) {
  const Scene scene = lit_wall(3, true, {1, 1, 1}, 1, 200);
  const View view = small_view(63, 37);
  Settings settings = volumes(PrepassSpecular::stored);
  const Image exact = render(scene, view, "light_prepass", settings);
  settings.set(setting::normals, NormalFormat::xyz8);
  const double error = compare_images(render(scene, view, "light_prepass", settings), exact).max_abs;
  EXPECT_GT(error, 0);
  EXPECT_LT(error, 0.05 * brightest_channel(exact));
}

TEST(LightPrepassFormats, RoughnessNeedsAChannelNextToTheNormal) {
  const Scene scene = rough_and_coated();
  Settings settings = volumes(PrepassSpecular::stored);
  for (const NormalFormat format : {NormalFormat::octahedral, NormalFormat::spheremap}) {
    settings.set(setting::normals, format);
    EXPECT_THROW(render(scene, small_view(9, 5), "light_prepass", settings), Error);
  }
}

// From the chromaticities of sRGB's primaries and white (IEC 61966-2-1), in double.
glm::dvec3 luv_by_hand(glm::dvec3 color) {
  constexpr glm::dvec2 red{0.64, 0.33}, green{0.30, 0.60}, blue{0.15, 0.06}, white{0.3127, 0.3290};
  const auto xyz = [](glm::dvec2 c) { return glm::dvec3(c.x / c.y, 1, (1 - c.x - c.y) / c.y); };
  const glm::dmat3 primaries(xyz(red), xyz(green), xyz(blue));
  const glm::dvec3 share = glm::inverse(primaries) * xyz(white);
  const glm::dvec3 sum = primaries * (share * color);
  const double all = sum.x + 15 * sum.y + 3 * sum.z;
  return {4 * sum.x / all, 9 * sum.y / all, sum.y};
}

// The matrix has four digits.
TEST(LightPrepassFormats, HueAndLuminanceAreThoseOfSrgb) {
  for (const glm::vec3 color : {glm::vec3(1), glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, 1),
                                glm::vec3(3, 0.5f, 0.01f), glm::vec3(1e-20f, 2e-20f, 0), glm::vec3(1e30f)}) {
    const glm::vec3 stored = luv_of_light(color);
    const glm::dvec3 expected = luv_by_hand(color);
    EXPECT_NEAR(stored.x * LUV_U_RANGE + LUV_U_FIRST, expected.x, 2e-4);
    EXPECT_NEAR(stored.y * LUV_V_RANGE + LUV_V_FIRST, expected.y, 2e-4);
    EXPECT_NEAR(stored.z / expected.z, 1, 1e-3);
    const glm::vec3 back = light_of_luv(stored);
    const float brightest = std::max({color.r, color.g, color.b});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back[c] / brightest, color[c] / brightest, 4e-6) << c;
  }
  EXPECT_EQ(light_of_luv(luv_of_light(glm::vec3(0))), glm::vec3(0));
}

Settings with_bits(const char* color, int bits) {
  Settings settings = assigned(fmt::format("brdf=lambert light-buffer={}", color));
  settings.set(setting::buffer_bits, bits);
  return settings;
}

TEST(LightPrepassFormats, LuvShowsTheSamePicture) {
  const Scene scene = rough_and_coated();
  const View view = small_view(71, 37);
  for (const char* form : {"", "kernel-shape=group", "raster=opencl", "prepass-specular=luminance"}) {
    SCOPED_TRACE(form);
    Settings rgb = *form ? assigned(form) : Settings();
    Settings luv = rgb;
    luv.set(setting::light_buffer_color, LightBufferColor::luv);
    const Image expected = render(scene, view, "light_prepass", rgb);
    const Image drawn = render(scene, view, "light_prepass", luv);
    EXPECT_LT(compare_images(drawn, expected).max_rel, 2e-5);
    EXPECT_FALSE(same_bytes(drawn, expected)) << "the setting has no effect";
  }
}

// Luminance is smaller than the brightest channel, and has the same steps.
TEST(LightPrepassFormats, LuvIn8BitsRoundsAboutAsRgbDoes) {
  const Scene scene = lit_wall(3, false, {1, 1, 1}, 0, 32);
  const View view = small_view(63, 37);
  const Image exact = render(scene, view, "light_prepass", with_bits("rgb", 32));
  for (const auto& [bits, bound] : {std::pair(8, 8e-3), {16, 8e-4}}) {
    const auto error = [&, bits = bits](const char* color) {
      return compare_images(render(scene, view, "light_prepass", with_bits(color, bits)), exact).rmse /
             brightest_channel(exact);
    };
    const double rgb = error("rgb"), luv = error("luv");
    fmt::print("{} bits: rgb {:.2e}, luv {:.2e}\n", bits, rgb, luv);
    EXPECT_LT(luv, bound);
    EXPECT_GT(luv, bound / 100);
    EXPECT_LT(rgb, bound);
  }
}

// A lamp next to the wall is brighter than 8 bits can store. Red, green and blue are cut off one by one.
TEST(LightPrepassFormats, LuvKeepsTheHueOfLightThatIsCutOff) {
  Scene scene = lit_wall(0, true, {1, 1, 1}, 0, 32);
  add_point(scene, "lamp", {0, 0, -3.7}, {1, 0.25f, 0.25f}, 3, 6);
  const View view = small_view(63, 37);
  const auto green_over_red = [&](const char* color, int bits) {
    const glm::vec4& middle = render(scene, view, "light_prepass", with_bits(color, bits)).at(31, 18);
    return middle.g / middle.r;
  };
  EXPECT_NEAR(green_over_red("rgb", 32), 0.25, 1e-4);
  EXPECT_GT(green_over_red("rgb", 8), 0.9);
  EXPECT_NEAR(green_over_red("luv", 8), 0.25, 0.02);
}

TEST(LightPrepassFormats, LuvCannotBeAddedByBlending) {
  Settings settings = with_bits("luv", 32);
  apply_setting(settings, "prepass-lights=volumes");
  EXPECT_THROW(render(rough_and_coated(), small_view(9, 5), "light_prepass", settings), Error);
}

}  // namespace
}  // namespace lightgrid
