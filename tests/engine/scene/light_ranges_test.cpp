#include "scene/light_ranges.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lightgrid {
namespace {

Light lamp(float intensity) {
  Light light;
  light.color = {0.5f, 1, 0.25f};
  light.intensity = intensity;
  light.radius_m = 3;
  return light;
}

TEST(LightRanges, AreTheScenesUnlessOthersAreAskedFor) {
  EXPECT_EQ(range_of(lamp(8), 0, {}), 3);
  EXPECT_EQ(min_falloff(lamp(8), {}), 0);
}

TEST(LightRanges, EndWhereIrradianceFallsToTheCutoff) {
  EXPECT_DOUBLE_EQ(range_of(lamp(8), 0, {.range = LightRange::cutoff, .cutoff = 0.02}),
                   20);  // 8 / 20^2 = 0.02
  EXPECT_EQ(range_of(lamp(0), 0, {.range = LightRange::cutoff}), 0);
}

TEST(LightRanges, AreInfiniteForDirectionalLightsAlways) {
  Light sun = lamp(1);
  sun.type = LightType::directional;
  for (const LightRange range :
       {LightRange::cutoff, LightRange::stochastic, LightRange::infinite, LightRange::scene}) {
    EXPECT_TRUE(std::isinf(range_of(sun, 0, {.range = range})));
  }
}

// p = min(f / alpha, 1), by counting over seeds and over indices: f = 8 / d^2, alpha = 0.5.
TEST(LightRanges, ReachAPointWithTheProbabilityOfItsIrradiance) {
  constexpr int draws = 40000;
  for (const bool over_seeds : {true, false}) {
    for (const double distance : {3.9, 5.0, 8.0, 16.0}) {
      int reached = 0;
      for (int i = 0; i < draws; ++i) {
        const LightRanges ranges{
            .range = LightRange::stochastic, .alpha = 0.5, .seed = over_seeds ? uint32_t(i) : 7u};
        reached += distance < range_of(lamp(8), over_seeds ? 3 : size_t(i), ranges);
      }
      const double p = std::min(8 / (distance * distance) / 0.5, 1.0);
      EXPECT_NEAR(double(reached) / draws, p, 4 * std::sqrt(p * (1 - p) / draws) + 1e-12) << distance;
    }
  }
}

// Lights of one seed must not share their luck: reaches of neighbours by index, and of one light in
// neighbouring seeds.
TEST(LightRanges, AreIndependentBetweenLightsAndSeeds) {
  constexpr int draws = 40000;
  const auto far = [](uint32_t seed, size_t index) {  // reached with p = 1/4
    return 8.0 < range_of(lamp(8), index, {.range = LightRange::stochastic, .alpha = 0.5, .seed = seed});
  };
  int lights = 0, seeds = 0;
  for (uint32_t i = 0; i < draws; ++i) {
    lights += far(9, i) && far(9, i + 1);
    seeds += far(i, 5) && far(i + 1, 5);
  }
  const double expected = 1.0 / 16, error = 4 * std::sqrt(expected * (1 - expected) / draws) * 1.2;
  EXPECT_NEAR(double(lights) / draws, expected, error);
  EXPECT_NEAR(double(seeds) / draws, expected, error);
}

// 300 lights ten metres from a triangle of a millimetre.
template <typename Intensity>
Scene lights_above_a_speck(Intensity intensity_of) {
  Scene scene;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.positions = {{0, 0, 0}, {1e-3f, 0, 0}, {0, 1e-3f, 0}};
  mesh.indices = {0, 1, 2};
  scene.instances.push_back({"speck", 0, glm::dmat4(1)});
  for (int i = 0; i < 300; ++i) {
    Light light;
    light.position = {0, 0, 10};
    light.intensity = intensity_of(i);
    scene.lights.push_back(light);
  }
  return scene;
}

// 30 of irradiance 4, 270 of 1.5.
TEST(LightRanges, HelpfulCutoffLeavesAnEighthOfTheLights) {
  EXPECT_TRUE(helpful_cutoffs(Scene()).empty()) << "no surface";
  Scene scene = lights_above_a_speck([](int i) { return i % 10 ? 150.0f : 400.0f; });
  const std::vector<CutoffEffect> effects = helpful_cutoffs(scene);
  ASSERT_EQ(effects.size(), 1) << "less would leave all 300";
  EXPECT_DOUBLE_EQ(effects[0].cutoff, 2);
  EXPECT_DOUBLE_EQ(effects[0].lights, 30);
  EXPECT_NEAR(effects[0].share, 120 * 0.75 / 525, 1e-6) << "1 - (2 / 4)^2 is left by the window";
  scene.lights.resize(8);
  EXPECT_NEAR(helpful_cutoffs(scene)[0].cutoff, 1e-4, 1e-12) << "eight lights are few";
}

// 30 of irradiance 10, 90 of 3 and 180 of 0.3, which are 300, 270 and 54 of 624.
TEST(LightRanges, HelpfulCutoffsThatKeepMoreLightComeAfterIt) {
  const Scene scene = lights_above_a_speck([](int i) { return i < 30 ? 1000.0f : i < 120 ? 300.0f : 30.0f; });
  const std::vector<CutoffEffect> effects = helpful_cutoffs(scene);
  ASSERT_EQ(effects.size(), 3);
  EXPECT_DOUBLE_EQ(effects[0].cutoff, 5);
  EXPECT_NEAR(effects[0].share, 300 * 0.75 / 624, 1e-6);
  EXPECT_DOUBLE_EQ(effects[1].cutoff, 2);
  EXPECT_DOUBLE_EQ(effects[1].lights, 120);
  EXPECT_NEAR(effects[1].share, (300 * 0.96 + 270 * (1 - 4 / 9.0)) / 624, 1e-6);
  EXPECT_DOUBLE_EQ(effects[2].cutoff, 0.5);
  EXPECT_NEAR(effects[2].share, (300 * (1 - 1 / 400.0) + 270 * (1 - 1 / 36.0)) / 624, 1e-6);
}

}  // namespace
}  // namespace lightgrid
