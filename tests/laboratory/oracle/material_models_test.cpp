// Skin, Minnaert and clearcoat of the oracle, by hand.
#include "oracle/shading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "oracle/near_vectors.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;
using std::numbers::pi;

const dvec3 overhead(0, 0, 1);

// A direction whose cosine with overhead is `mu`.
dvec3 at_cosine(double mu, double turn = 0) {
  const double s = std::sqrt(1 - mu * mu);
  return {s * std::cos(turn), s * std::sin(turn), mu};
}

TEST(Skin, ByHand) {
  // R = 1/2. At a cosine of 1/4: t = 1/2 of -1/2 .. 1, smoothstep 1/2; of 0 .. 1 it is 3/16 - 2/64 = 5/32.
  // 1/2 - 5/32 = 11/32.
  const Surface skin{.base_color = dvec3(0), .subsurface_color = {1, 0.5, 0}, .roll_off = 0.5};
  const auto lambert = [&](double mu) { return reflected(skin, overhead, at_cosine(mu), Brdf::lambert); };
  expect_near(lambert(0.25), dvec3(1, 0.5, 0) * (11.0 / 32 / pi), 1e-15);
  // At the terminator t = 1/3: 3/9 - 2/27 = 7/27. At -1/4, behind it, t = 1/6: 3/36 - 2/216 = 2/27.
  expect_near(lambert(0), dvec3(1, 0.5, 0) * (7.0 / 27 / pi), 1e-15);
  expect_near(lambert(-0.25), dvec3(1, 0.5, 0) * (2.0 / 27 / pi), 1e-15);
  EXPECT_EQ(lambert(-0.5), dvec3(0));
  EXPECT_EQ(lambert(-1), dvec3(0));
  EXPECT_EQ(lambert(1), dvec3(0));
  // Added to what the surface reflects without it, whatever the lobe; under a coat of 0.04 at normal
  // incidence.
  const Surface bare{.roughness = 0.5}, both{.roughness = 0.5, .subsurface_color = dvec3(1), .roll_off = 0.5};
  const dvec3 to_light = at_cosine(0.25);
  expect_near(reflected(both, overhead, to_light) - reflected(bare, overhead, to_light),
              dvec3(11.0 / 32 / pi), 1e-15);
  const Surface coated{.base_color = dvec3(0), .coat = 1, .subsurface_color = dvec3(1), .roll_off = 0.5};
  expect_near(reflected(coated, overhead, at_cosine(-0.25)), dvec3(0.96 * 2.0 / 27 / pi), 1e-15);
}

TEST(Minnaert, ByHand) {
  // k = 1/2, light at a cosine of 1/4, eye at 1/9: 1/2 * 1/3.
  const Surface moon{.base_color = {1, 0.5, 0}, .minnaert_k = 0.5};
  expect_near(reflected(moon, at_cosine(1.0 / 9), at_cosine(0.25), Brdf::lambert),
              dvec3(1, 0.5, 0) * (1 / 6.0 / pi), 1e-15);
  // k = 2: 1/16 * 9.
  const Surface velvet{.base_color = {1, 0.5, 0}, .minnaert_k = 2};
  expect_near(reflected(velvet, at_cosine(1.0 / 9), at_cosine(0.25), Brdf::lambert),
              dvec3(1, 0.5, 0) * (9 / 16.0 / pi), 1e-15);
  EXPECT_EQ(reflected(moon, overhead, at_cosine(0), Brdf::lambert), dvec3(0));
  EXPECT_EQ(reflected(moon, overhead, at_cosine(-0.5), Brdf::lambert), dvec3(0));
  // A metal has no diffuse part to change.
  const Surface metal{.metallic = 1, .roughness = 0.5},
      minnaert_metal{.metallic = 1, .roughness = 0.5, .minnaert_k = 0.5};
  EXPECT_EQ(reflected(minnaert_metal, overhead, at_cosine(0.25)),
            reflected(metal, overhead, at_cosine(0.25)));
}

// Constant radiance from all sides: the sum over all directions is the ambient term.
TEST(Models, ReflectAmbientLightAsTheyReflectLightsFromAllSides) {
  for (const auto& [roll_off, k] :
       {std::pair(0.3, 1.0), std::pair(1.0, 1.0), std::pair(0.0, 0.5), std::pair(0.6, 1.7)}) {
    const Surface s{
        .base_color = {1, 0.5, 0.25}, .subsurface_color = {0.5, 1, 0}, .roll_off = roll_off, .minnaert_k = k};
    const dvec3 to_eye = at_cosine(0.4);
    constexpr int steps = 2000;
    dvec3 sum(0);
    for (int i = 0; i < steps; ++i)
      sum += reflected(s, to_eye, at_cosine(2 * (i + 0.5) / steps - 1), Brdf::lambert);
    const dvec3 ambient = shade(s, -3.0 * to_eye, false, {}, {.brdf = Brdf::lambert, .ambient = dvec3(1)});
    expect_near(sum * (4 * pi / steps), ambient, 1e-4);
  }
}

TEST(Coat, FromStraightAboveByHand) {
  // N = V = L, both roughnesses 1: the base 0.97 / pi, the coat 1 / (4 pi), Fresnel 0.04.
  const Surface coated{.coat = 1, .coat_roughness = 1};
  expect_near(reflected(coated, {0, 0, 1}, {0, 0, 1}), dvec3((0.96 * 0.97 + 0.04 / 4) / pi), 1e-15);
  // Half a coat, smoother: alpha 1/4, D = 16 / pi, V = 1/4.
  const Surface half{.coat = 0.5, .coat_roughness = 0.5};
  expect_near(reflected(half, {0, 0, 1}, {0, 0, 1}), dvec3((0.98 * 0.97 + 0.02 * 4) / pi), 1e-14);
  EXPECT_EQ(reflected(half, {0, 0, 1}, {0, 0, 1}, Brdf::lambert), dvec3(1 / pi));
}

TEST(Coat, HasItsOwnNormalAndCosine) {
  // The eye straight above the coat, 60 degrees off the base's normal; the light there too.
  const dvec3 up(0, 0, 1), tilted(std::sqrt(0.75), 0, 0.5);
  const Surface coated{.normal = tilted, .coat = 1, .coat_roughness = 1, .coat_normal = up};
  const double base = brdf(coated, up, up).x * 0.5;
  expect_near(reflected(coated, up, up), dvec3(0.96 * base + 0.04 / (4 * pi)), 1e-15);
  // Seen at 60 degrees from the coat's normal: Fresnel 0.04 + 0.96 / 32 = 0.07. A light behind the base, in
  // front of the coat: the coat alone, V + L at 30 degrees from both.
  const dvec3 across(-std::sqrt(0.75), 0, 0.5);
  const Surface behind{.normal = tilted, .coat = 1, .coat_roughness = 1, .coat_normal = up};
  EXPECT_EQ(reflected({.normal = tilted}, tilted, across), dvec3(0));
  // H = up: D = 1 / pi, V = 0.5 / (0.5 + 0.5) = 1/2; N.L = 1/2.
  expect_near(reflected(behind, tilted, across), dvec3(0.07 / (4 * pi)), 1e-15);
}

TEST(Coat, ReflectsAmbientLightAndDarkensWhatIsEmitted) {
  const Surface coated{
      .base_color = dvec3(0.5), .emissive = dvec3(3), .metallic = 0.5, .occlusion = 0.5, .coat = 0.5};
  // Without it 0.52 * 0.1 * 0.5 + 3 (Shade.Ambient...); the coat's share is 0.02 of 0.1 * 0.5.
  expect_near(shade(coated, {0, 0, -3}, false, {}, {.ambient = dvec3(0.1)}),
              dvec3(0.98 * 3.026 + 0.02 * 0.05), 1e-15);
}

TEST(Coat, GivesBackNoMoreThanArrives) {
  for (double roughness : {0.2, 0.6, 1.0}) {
    for (double eye_angle : {0.0, 0.6, 1.2, 1.5}) {
      const dvec3 to_eye(std::sin(eye_angle), 0, std::cos(eye_angle));
      const Surface coated{.metallic = 1, .roughness = 0.5, .coat = 1, .coat_roughness = roughness};
      const int steps = 400;
      double albedo = 0;
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
          const double mu = (i + 0.5) / steps, turn = 2 * pi * (j + 0.5) / steps, s = std::sqrt(1 - mu * mu);
          albedo += reflected(coated, to_eye, {s * std::cos(turn), s * std::sin(turn), mu}).x;
        }
      }
      EXPECT_LT(albedo * 2 * pi / steps / steps, 1.001) << roughness << " " << eye_angle;
    }
  }
}

TEST(Coat, IsFiniteAtEveryEdge) {
  for (double roughness : {0.0, 1.0}) {
    for (const dvec3& coat_normal : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0, 0, -1)}) {
      for (const dvec3& to_eye : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0.6, 0, -0.8), dvec3(0, 0, -1)}) {
        for (const dvec3& to_light : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(-0.6, 0, 0.8)}) {
          const Surface coated{.coat = 1, .coat_roughness = roughness, .coat_normal = coat_normal};
          EXPECT_TRUE(finite_and_not_negative(reflected(coated, to_eye, to_light)));
        }
      }
    }
  }
}

}  // namespace
}  // namespace lightgrid::lab
