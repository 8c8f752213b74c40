// The oracle's BRDFs: by hand, and by energy, reciprocity and finite values.
#include "oracle/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "oracle/near_vectors.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;
using std::numbers::pi;

TEST(Brdf, RoughDielectricFromStraightAbove) {
  // N = V = L = H, alpha 1: F = 0.04; V = 0.5 / (1 + 1) = 1/4; D = 1 / pi.
  // 0.96 / pi + 0.04 / 4 / pi = 0.97 / pi.
  expect_near(brdf({}, {0, 0, 1}, {0, 0, 1}), dvec3(0.97 / pi), 1e-15);
}

TEST(Brdf, MetalFromStraightAbove) {
  // Roughness 0.5: alpha 1/4, k = (1/4) / (1/16) = 4, D = 16 / pi; V = 1/4; F = base; no diffuse.
  const Surface gold{.base_color = {1, 0.5, 0}, .metallic = 1, .roughness = 0.5};
  expect_near(brdf(gold, {0, 0, 1}, {0, 0, 1}), dvec3(4 / pi, 2 / pi, 0), 1e-14);
}

TEST(Brdf, RoughDielectricLitAtSixtyDegrees) {
  // V = N; H at 30 degrees: 1 - cos 30 = 0.1339745962, to the fifth 4.316315e-5; F = 0.04 + 0.96 * that
  // = 0.0400414366. alpha 1: V = 0.5 / (0.5 + 1) = 1/3, D = 1 / pi.
  // (1 - F + F / 3) / pi = 0.9733057089 / pi.
  const dvec3 to_light(std::sqrt(0.75), 0, 0.5);
  expect_near(brdf({}, {0, 0, 1}, to_light), dvec3(0.9733057089 / pi), 1e-10);
}

TEST(Brdf, PartialMetalIsTheMixOfADielectricAndAMetal) {
  // N = V = L = H, alpha 1: the lobe is 1 / (4 pi). Dielectric: 0.96 base / pi + 0.04 / (4 pi); metal: base /
  // (4 pi). For base 1, 0.5, 0 and a metalness of a quarter, times pi: 3/4 (0.97, 0.49, 0.01) + 1/4 (0.25,
  // 0.125, 0).
  const Surface surface{.base_color = {1, 0.5, 0}, .metallic = 0.25};
  expect_near(brdf(surface, {0, 0, 1}, {0, 0, 1}), dvec3(0.79, 0.39875, 0.0075) / pi, 1e-15);
  // At grazing angles Fresnel is next to 1: nothing diffuse is left, whatever the metal.
  const dvec3 to_eye(1, 0, 1e-3), to_light(-1, 0, 1e-3);
  const double f = std::pow(1 - glm::normalize(to_eye).z, 5);
  const double white = brdf({.metallic = 1}, glm::normalize(to_eye), glm::normalize(to_light)).x;
  EXPECT_NEAR(brdf({.metallic = 0.5}, glm::normalize(to_eye), glm::normalize(to_light)).x,
              white * (0.5 + 0.5 * (0.04 + 0.96 * f)) + 0.5 * 0.96 * (1 - f) / pi, 1e-12 * white);
}

TEST(Brdf, SpecularReflectanceByHand) {
  // From straight above, as RoughDielectricFromStraightAbove: (1 - max F0) base / pi + F0 / (4 pi).
  const Surface colored{.base_color = {1, 0.5, 0}, .f0 = {0.4, 0.2, 0.1}, .f90 = 0.5};
  expect_near(brdf(colored, {0, 0, 1}, {0, 0, 1}) * pi, {0.6 + 0.1, 0.3 + 0.05, 0.025}, 1e-15);
  // Lobe and g = (1 - V.H)^5 of a grazing light from those of a white metal: F = F0 + (F90 - F0) g; a white
  // base keeps 1 - max F. Metal has F90 = 1.
  const dvec3 to_eye = glm::normalize(dvec3(1, 0, 1e-3)), to_light = glm::normalize(dvec3(-1, 0, 1e-3));
  const double white = brdf({.metallic = 1}, to_eye, to_light).x, g = std::pow(1 - to_eye.z, 5);
  const dvec3 f = dvec3(0.4, 0.2, 0.1) * (1 - g) + 0.5 * g;
  expect_near(brdf({.f0 = {0.4, 0.2, 0.1}, .f90 = 0.5}, to_eye, to_light), (1 - f.r) / pi + f * white,
              1e-12 * white);
  Surface metal = colored;
  metal.metallic = 1;
  EXPECT_EQ(brdf(metal, to_eye, to_light),
            brdf({.base_color = {1, 0.5, 0}, .metallic = 1}, to_eye, to_light));
}

TEST(Brdf, BlinnPhongByHand) {
  // Roughness 0.5: alpha 1/4, n = 2 * 16 - 2 = 30. From straight above: 32 / (8 pi) = 4 / pi, as GGX.
  const Surface gold{.base_color = {1, 0.5, 0}, .metallic = 1, .roughness = 0.5};
  expect_near(brdf(gold, {0, 0, 1}, {0, 0, 1}, Brdf::blinn), dvec3(4 / pi, 2 / pi, 0), 1e-14);
  // A white metal lit at sixty degrees: H at 30 degrees, F = 1: 4 / pi * cos^30(30 degrees) = 4 / pi *
  // 0.75^15.
  const dvec3 to_light(std::sqrt(0.75), 0, 0.5);
  expect_near(brdf({.metallic = 1, .roughness = 0.5}, {0, 0, 1}, to_light, Brdf::blinn),
              dvec3(4 / pi * std::pow(0.75, 15)), 1e-14);
}

TEST(Brdf, LambertIsBaseColourOverPiWhateverTheRestOfTheMaterial) {
  for (const double metallic : {0.0, 0.3, 1.0}) {
    const Surface surface{.base_color = {1, 0.5, 0.25}, .metallic = metallic, .roughness = 1 - metallic};
    for (const dvec3& to_light : {dvec3(0, 0, 1), dvec3(0.6, 0, 0.8), dvec3(0, 0, -1)}) {
      expect_near(brdf(surface, {0, 0, 1}, to_light, Brdf::lambert) * pi, {1, 0.5, 0.25}, 1e-15);
    }
    expect_near(shade(surface, {0, 0, -3}, false, {}, {.brdf = Brdf::lambert, .ambient = dvec3(0.2)}),
                {0.2, 0.1, 0.05}, 1e-15);
  }
}

TEST(Brdf, SeenFromBehindTheHalfVectorCountsAsLyingInTheSurface) {
  // V + L = (1.4, 0, -0.2), of length sqrt 2: N.H < 0 counts as 0, |N x H|^2 = 0.98. Alpha 1, white metal: F
  // = 1, D = 1 / (0.98^2 pi), N.V = 1e-4, N.L = 0.6: V = 0.5 / (0.6 + 1e-4).
  const dvec3 got = brdf({.metallic = 1}, {0.6, 0, -0.8}, {0.8, 0, 0.6});
  expect_near(got, dvec3(0.5 / 0.6001 / (0.9604 * pi)), 1e-15);
}

TEST(Brdf, WhiteMetalReturnsOneMinusLogTwoAtFullRoughness) {
  // V = N, alpha 1, F = 1: brdf = 1 / (2 pi (1 + mu)). Over the hemisphere, integral of mu / (1 + mu) over
  // 0 <= mu <= 1 is 1 - ln 2.
  const Surface white{.metallic = 1};
  const int steps = 2000;
  double albedo = 0;
  for (int i = 0; i < steps; ++i) {
    const double mu = (i + 0.5) / steps;
    albedo += brdf(white, {0, 0, 1}, {std::sqrt(1 - mu * mu), 0, mu}).x * mu * 2 * pi / steps;
  }
  EXPECT_NEAR(albedo, 1 - std::numbers::ln2, 1e-7);
}

TEST(Brdf, GivesBackNoMoreThanArrives) {
  for (double roughness : {0.2, 0.4, 0.7, 1.0}) {
    for (double eye_angle : {0.0, 0.6, 1.2, 1.5}) {
      const dvec3 to_eye(std::sin(eye_angle), 0, std::cos(eye_angle));
      const int steps = 600;
      double albedo = 0;
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
          const double mu = (i + 0.5) / steps, turn = 2 * pi * (j + 0.5) / steps, s = std::sqrt(1 - mu * mu);
          const dvec3 to_light(s * std::cos(turn), s * std::sin(turn), mu);
          albedo += brdf({.metallic = 1, .roughness = roughness}, to_eye, to_light).x * mu;
        }
      }
      albedo *= 2 * pi / steps / steps;
      EXPECT_LT(albedo, 1.001) << roughness << " " << eye_angle;
      if (roughness < 0.3 && eye_angle < 1) {
        EXPECT_GT(albedo, 0.97) << eye_angle;  // nearly smooth: little is shadowed
      }
    }
  }
}

TEST(Brdf, IsReciprocal) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(0, 1);
  for (int i = 0; i < 1000; ++i) {
    const Surface surface{.base_color = {0.9, 0.5, 0.1}, .metallic = u(random), .roughness = u(random)};
    auto above = [&] {
      const double mu = 0.01 + 0.99 * u(random), turn = 2 * pi * u(random), s = std::sqrt(1 - mu * mu);
      return dvec3(s * std::cos(turn), s * std::sin(turn), mu);
    };
    const dvec3 a = above(), b = above();
    const dvec3 forth = brdf(surface, a, b), back = brdf(surface, b, a);
    expect_near(forth, back, 1e-11 * std::max(1.0, forth.x));
  }
}

TEST(Brdf, IsFiniteAtEveryEdge) {
  for (double roughness : {0.0, 1e-300, 0.045, 1.0}) {
    for (double metallic : {0.0, 1.0}) {
      for (const dvec3& to_eye : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(0.6, 0, -0.8), dvec3(0, 0, -1)}) {
        for (const dvec3& to_light : {dvec3(0, 0, 1), dvec3(1, 0, 0), dvec3(-1, 0, 0), dvec3(-0.6, 0, 0.8)}) {
          const Surface surface{.metallic = metallic, .roughness = roughness};
          EXPECT_TRUE(finite_and_not_negative(brdf(surface, to_eye, to_light)))
              << roughness << " " << metallic;
        }
      }
    }
  }
}

TEST(Brdf, RoughnessIsFloored) {
  // alpha 0.045^2 = 0.002025: D = 1 / (pi alpha^2), V = 1/4, F = 1.
  const double alpha = 0.002025;
  const Surface mirror{.metallic = 1, .roughness = 0};
  EXPECT_NEAR(brdf(mirror, {0, 0, 1}, {0, 0, 1}).x * 4 * pi * alpha * alpha, 1, 1e-12);
}

}  // namespace
}  // namespace lightgrid::lab
