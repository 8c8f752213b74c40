// A pixel's radiance from all its lights.
#include "oracle/shading.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "oracle/infinity.h"
#include "oracle/near_vectors.h"
#include "oracle/position.h"
#include "oracle/test_views.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;
using std::numbers::pi;

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
}  // namespace lightgrid::lab
