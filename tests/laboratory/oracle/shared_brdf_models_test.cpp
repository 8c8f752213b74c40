#define SKIN
#define MINNAERT
#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

// As GgxIsTheReferencesInFloat. Where k < 1 the slope of (n.l)^k grows towards the terminator: a rounding of
// n.l by 1e-7 is one of up to (1e-7)^k there, here 1e-2 with k = 0.3 at 1 of 10^6 points; it shows on no
// sampled point.
TEST(SharedBrdf, SkinAndMinnaertAreTheReferencesInFloat) { EXPECT_LT(largest_error(Brdf::ggx, 0.3), 2e-5); }

TEST(SharedBrdf, APowerIsWithinItsBound) {
  double largest = 0;
  for (int i = 0; i <= 40; ++i) {
    const float e = float(i) / 20 - 1;
    for (float x = 1e-30f; x <= 1; x = x * 1.0137f + 1e-38f) {
      largest = std::max(largest, std::abs(power_of(x, e) / std::pow(double(x), double(e)) - 1));
      ASSERT_EQ(power_of(x, 0), 1);
    }
    ASSERT_EQ(power_of(1, e), 1);
  }
  EXPECT_LT(largest, 6e-6);
  for (float x = 1e-7f; x <= 1; x *= 1.00137f) {
    ASSERT_LT(std::abs(power_of(x, -0.7f) / std::pow(double(x), double(-0.7f)) - 1), 2e-6) << x;
    ASSERT_LT(std::abs(power_of(x, 0.9f) / std::pow(double(x), double(0.9f)) - 1), 2e-6) << x;
  }
}

TEST(SharedBrdf, AmbientLightOnSkinAndMinnaertIsTheReferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 1000; ++i) {
    const Surface surface{.normal = {0, 0, 1},
                          .base_color = {uniform(random), uniform(random), uniform(random)},
                          .metallic = uniform(random),
                          .subsurface_color = {uniform(random), 0, 1},
                          .roll_off = uniform(random),
                          .minnaert_k = 0.1 + 1.9 * uniform(random)};
    const double tilt = 1.5 * uniform(random);
    const glm::dvec3 to_viewer(std::sin(tilt), 0, std::cos(tilt)), ambient(0.1, 0.2, 0.3);
    const glm::dvec3 want = shade(surface, -2.0 * to_viewer, false, {}, {.ambient = ambient});
    ShadingPoint p = shading_point(-2.0 * to_viewer, to_viewer, surface.normal, surface.base_color,
                                   real(surface.metallic), 1);
    p = with_minnaert(with_skin(p, surface.subsurface_color, real(surface.roll_off)), to_viewer,
                      real(surface.minnaert_k));
    const glm::vec3 got = reflected_ambient(p, 0.1f, 0.2f, 0.3f);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-6) << i;
  }
}

// Code that is there, but for a material of neither, changes no bit.
TEST(SharedBrdf, ARollOffOfZeroAndAKOfOneAreLambert) {
  std::mt19937 random(9);
  for (int i = 0; i < 1000; ++i) {
    const glm::vec3 normal = random_direction(random), to_light = random_direction(random);
    const ShadingPoint p = with_minnaert(
        with_skin(shading_point({0, 0, -2}, {0, 0, 1}, normal, {0.5f, 0.3f, 0.1f}, 0.3f, 0.2f), {1, 1, 1}, 0),
        {0, 0, 1}, 1);
    const ShadingPoint other =
        with_minnaert(with_skin(shading_point({0, 0, -2}, {0, 0, 1}, normal, {0.5f, 0.3f, 0.1f}, 0.3f, 0.2f),
                                {0, 0, 0}, 0.5f),
                      {0, 0, 1}, 1);
    ASSERT_EQ(reflected(p, to_light), reflected(other, to_light));
    ASSERT_EQ(reflected_ambient(p, 1, 1, 1), reflected_ambient(other, 1, 1, 1));
    ASSERT_EQ(DIFFUSE_AT(p, cosine_of(normal, to_light)), p.diffuse);
  }
}

}  // namespace
}  // namespace lightgrid::lab
