#define CLEARCOAT
#include "oracle/shared_brdf.h"

namespace lightgrid::lab {
namespace {

TEST(SharedBrdf, GgxUnderACoatIsTheReferencesInFloat) {
  EXPECT_LT(largest_error(Brdf::ggx, 0.3), 2e-5);
  EXPECT_LT(largest_error(Brdf::ggx, 0), 2e-3);  // as GgxIsTheReferencesInFloat
}

TEST(SharedBrdf, WhatAmbientAndEmittedLightBecomeUnderACoatIsTheReferences) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform;
  for (int i = 0; i < 1000; ++i) {
    const Surface surface{.normal = {0, 0, 1},
                          .base_color = {uniform(random), uniform(random), uniform(random)},
                          .emissive = {uniform(random), 0, 1},
                          .metallic = uniform(random),
                          .roughness = uniform(random),
                          .coat = uniform(random),
                          .coat_normal = random_direction(random)};
    const glm::dvec3 position(0, 0, -2), ambient(0.1, 0.2, 0.3);
    const glm::dvec3 want = shade(surface, position, false, {}, {.ambient = ambient});
    const ShadingPoint p = with_coat(shading_point(position, {0, 0, 1}, surface.normal, surface.base_color,
                                                   real(surface.metallic), real(surface.roughness)),
                                     surface.coat_normal, real(surface.coat), 0);
    const glm::vec3 got = UNDER_COAT(p, glm::vec3(surface.emissive)) + reflected_ambient(p, 0.1f, 0.2f, 0.3f);
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(got[c], want[c], 1e-6) << i;
  }
}

// A coat that is there, but of factor 0, changes no bit.
TEST(SharedBrdf, ACoatOfFactorZeroIsNone) {
  std::mt19937 random(9);
  for (int i = 0; i < 1000; ++i) {
    const ShadingPoint p =
        shading_point({0, 0, -2}, {0, 0, 1}, random_direction(random), {0.5f, 0.3f, 0.1f}, 0.3f, 0.2f);
    const glm::vec3 to_light = random_direction(random);
    const ShadingPoint none = with_coat(p, random_direction(random), 0, 0.1f);
    const ShadingPoint other = with_coat(p, random_direction(random), 0, 0.9f);
    ASSERT_EQ(reflected(none, to_light), reflected(other, to_light));
    ShadingPoint coated = with_coat(p, p.normal, 1, 0.2f);
    ASSERT_EQ(reflected_ambient(none, 1, 1, 1), BASE_REFLECTANCE(coated));
  }
}

}  // namespace
}  // namespace lightgrid::lab
