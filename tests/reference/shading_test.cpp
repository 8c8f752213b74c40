#include "reference/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "reference/infinity.h"
#include "reference/position.h"
#include "reference/test_views.h"

namespace lightgrid {
namespace {

using glm::dvec3;
using std::numbers::pi;

void expect_near(const dvec3& got, const dvec3& want, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance) << "channel " << i;
}

bool finite_and_not_negative(const dvec3& c) {
  for (int i = 0; i < 3; ++i) {
    if (!(std::isfinite(c[i]) && c[i] >= 0)) return false;
  }
  return true;
}

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
  // Of a metal there is no diffuse part to change.
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

TEST(Shade, LightStraightAboveARoughDielectric) {
  // Surface 3 m in front of the eye and facing it, light of 2 cd 2 m above: 0.97 / pi * 2 / 4.
  const std::vector<ViewLight> lights = {{.position = {0, 0, -1}, .radiant_intensity = dvec3(2)}};
  expect_near(shade({}, {0, 0, -3}, false, lights, {}), dvec3(0.485 / pi), 1e-15);
}

TEST(Shade, WindowIsTheOnlyDifferenceOfTheTwoReferences) {
  // Radius 4 at 2 m: 15/16.
  const std::vector<ViewLight> lights = {{.position = {0, 0, -1}, .radius_m = 4}};
  const dvec3 open = shade({}, {0, 0, -3}, false, lights, {.window = false});
  expect_near(shade({}, {0, 0, -3}, false, lights, {.window = true}), open * (15.0 / 16), 1e-15);
}

TEST(Shade, AmbientTermIsDiffuseAndNormalReflectanceTimesOcclusion) {
  // Half metal, base 0.5: diffuse 0.25, reflectance (0.04 + 0.5) / 2 = 0.27; 0.52 * 0.1 * 0.5 + 3.
  const Surface surface{.base_color = dvec3(0.5), .emissive = dvec3(3), .metallic = 0.5, .occlusion = 0.5};
  expect_near(shade(surface, {0, 0, -3}, false, {}, {.ambient = dvec3(0.1)}), dvec3(3.026), 1e-15);
}

TEST(Shade, UnlitIsItsBaseColourAlone) {
  const Surface surface{.base_color = {0.1, 0.2, 0.3}, .emissive = dvec3(5), .unlit = true};
  const std::vector<ViewLight> lights = {{.type = LightType::directional}};
  EXPECT_EQ(shade(surface, {0, 0, -3}, false, lights, {.ambient = dvec3(1)}), dvec3(0.1, 0.2, 0.3));
}

TEST(Shade, DirectionalLightFromBehindTheSurfaceAddsNothing) {
  std::vector<ViewLight> lights = {{.type = LightType::directional, .direction = {0, 0, 1}}};
  EXPECT_EQ(shade({}, {0, 0, -3}, false, lights, {}), dvec3(0));
  lights[0].direction = {0, 0, -1};
  expect_near(shade({}, {0, 0, -3}, false, lights, {}), dvec3(0.97 / pi), 1e-15);
}

TEST(Shade, OrthographicViewLooksAlongMinusZEverywhere) {
  const std::vector<ViewLight> lights = {{.type = LightType::directional, .direction = {0, 0, -1}}};
  expect_near(shade({}, {100, 0, -3}, true, lights, {}), dvec3(0.97 / pi), 1e-15);
}

TEST(Shade, IsFiniteWithTheLightAtThePointOrAtTheEye) {
  for (const dvec3& place : {dvec3(0, 0, -3), dvec3(0, 0, 0), dvec3(0, 0, -3 + 1e-160)}) {
    for (LightType type : {LightType::point, LightType::spot}) {
      ViewLight light{.type = type, .position = place, .radius_m = 5};
      light.cos_outer = -0.5;
      EXPECT_TRUE(finite_and_not_negative(shade({}, {0, 0, -3}, false, {light}, {})));
    }
  }
}

TEST(ShadePixels, EqualsShadingOnePixelAtATime) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> u(0, 1);
  for (const View& view :
       {perspective_view(1, 1, 1, 1, 0.1, infinity), perspective_view(17, 9, 1, 0.5, 0.1, 50),
        orthographic_view(35, 18, 1, 1, 0.1, 9)}) {
    std::vector<float> depth(size_t(view.width) * view.height);
    for (float& d : depth) d = random() % 4 ? float(0.1 + 0.8 * u(random)) : 0.0f;
    depth[0] = 0.5f;
    std::vector<ViewLight> lights;
    for (int i = 0; i < 60; ++i) {
      lights.push_back({.position = {u(random), u(random), -u(random)}, .radius_m = 0.3 * u(random)});
    }
    lights.push_back({.type = LightType::directional});
    auto surface_at = [](uint32_t pixel) { return Surface{.roughness = 1 / (1.0 + pixel)}; };
    const std::vector<uint32_t> pixels = covered_pixels(depth);
    for (bool window : {false, true}) {
      const ShadeSettings settings{.ambient = dvec3(0.1), .window = window};
      const auto radiance = shade_pixels(view, depth, surface_at, lights, settings, pixels);
      ASSERT_EQ(radiance.size(), pixels.size());
      for (size_t i = 0; i < pixels.size(); ++i) {
        const uint32_t p = pixels[i];
        const dvec3 position = position_from_depth(view, p % view.width, p / view.width, depth[p]);
        EXPECT_EQ(radiance[i], shade(surface_at(p), position, view.orthographic, lights, settings));
      }
    }
  }
}

TEST(SamplePixels, AreDistinctSpreadAndAsManyAsAsked) {
  std::vector<uint32_t> pixels;
  for (uint32_t i = 0; i < 1000; ++i) pixels.push_back(3 * i);
  EXPECT_EQ(sample_pixels(pixels, 1000), pixels);
  EXPECT_EQ(sample_pixels(pixels, 5000), pixels);
  EXPECT_TRUE(sample_pixels(pixels, 0).empty());
  for (size_t most : {1, 7, 333, 999}) {
    const std::vector<uint32_t> samples = sample_pixels(pixels, most);
    ASSERT_EQ(samples.size(), most);
    for (size_t i = 0; i < most; ++i) {
      EXPECT_EQ(samples[i] % 3, 0u);
      EXPECT_GE(samples[i] / 3, i * 1000 / most);
      EXPECT_LT(samples[i] / 3, (i + 1) * 1000 / most);
    }
  }
}

}  // namespace
}  // namespace lightgrid
