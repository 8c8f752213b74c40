#define SPECULAR
#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

TEST(SharedBrdf, GgxOfAnyReflectanceIsTheReferencesInFloat) {
  EXPECT_LT(largest_error(Brdf::ggx, 0.3), 2e-5);
  EXPECT_LT(largest_error(Brdf::ggx, 0), 2e-3);  // as GgxIsTheReferencesInFloat
}

TEST(SharedBrdf, AmbientLightOfAnyReflectanceIsTheReferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 1000; ++i) {
    const float f90 = float(uniform(random));
    const glm::vec3 f0(f90 * uniform(random), f90 * uniform(random), f90 * uniform(random));
    const Surface surface{.base_color = {uniform(random), uniform(random), uniform(random)},
                          .metallic = uniform(random),
                          .f0 = f0,
                          .f90 = f90};
    const glm::dvec3 want = shade(surface, {0, 0, -2}, false, {}, {.ambient = {0.1, 0.2, 0.3}});
    const ShadingPoint p = with_specular(
        shading_point({0, 0, -2}, {0, 0, 1}, surface.normal, surface.base_color, real(surface.metallic), 1),
        real(surface.metallic), f0, f90);
    const glm::vec3 got = reflected_ambient(p, 0.1f, 0.2f, 0.3f);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-6) << i;
  }
}

// If another surface of the scene has a reflectance of its own, those of the default have the bits that
// they have without: bits of p, not of another program.
TEST(SharedBrdf, TheDefaultReflectanceChangesNoBit) {
  std::mt19937 random(9);
  std::uniform_real_distribution<float> uniform;
  for (int i = 0; i < 10000; ++i) {
    const float metallic = i % 4 ? uniform(random) : float(i / 4 % 2);
    const ShadingPoint p = shading_point({0, 0, -2}, {0, 0, 1}, random_direction(random),
                                         {uniform(random), uniform(random), 0}, metallic, uniform(random));
    const ShadingPoint same = with_specular(p, metallic, glm::vec3(0.04f), 1);
    ASSERT_EQ(same.f0, p.f0);
    ASSERT_EQ(same.f90, 1);
    ASSERT_EQ(same.diffuse_facing, 1);
    ASSERT_EQ(same.diffuse_always, 0);
  }
}

}  // namespace
}  // namespace lightgrid::lab
