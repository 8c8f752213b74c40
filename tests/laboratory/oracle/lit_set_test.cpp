#include "oracle/lit_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "oracle/attenuation.h"
#include "oracle/infinity.h"
#include "oracle/position.h"
#include "oracle/test_views.h"

namespace lightgrid::lab {
namespace {

using glm::dvec3;

ViewLight point(dvec3 position, double radius) { return {.position = position, .radius_m = radius}; }

ViewLight spot(dvec3 position, dvec3 direction, double radius, double cos_outer) {
  return {LightType::spot, position, direction, dvec3(1), radius, cos_outer + 0.1, cos_outer};
}

TEST(IsLit, ExactlyAtTheRadiusIsDark) {
  const ViewLight light = point({0, 0, -5}, 3);
  EXPECT_FALSE(is_lit(light, {0, 0, -2}));
  EXPECT_TRUE(is_lit(light, {0, 0, std::nextafter(-2.0, -3.0)}));
  EXPECT_FALSE(is_lit(light, {0, 0, std::nextafter(-2.0, 0.0)}));
}

TEST(IsLit, ExactlyOnTheConeIsDark) {
  // 3, 4, 5: the point (4, 0, -3) is 5 m off, and the cosine to -z is 3/5.
  const ViewLight light = spot({0, 0, 0}, {0, 0, -1}, 10, 0.6);
  EXPECT_FALSE(is_lit(light, {4, 0, -3}));
  EXPECT_TRUE(is_lit(light, {4, 0, -3.0000001}));
  EXPECT_FALSE(is_lit(light, {4, 0, -2.9999999}));
}

TEST(IsLit, WideConesLightBehindThemselves) {
  const ViewLight light = spot({0, 0, 0}, {0, 0, -1}, 10, -0.6);
  EXPECT_TRUE(is_lit(light, {4, 0, 2.9999999}));
  EXPECT_FALSE(is_lit(light, {4, 0, 3}));
}

TEST(IsLit, RadiusZeroLightsNothingAndInfinityEverything) {
  EXPECT_FALSE(is_lit(point({1, 2, 3}, 0), {1, 2, 3}));
  EXPECT_FALSE(is_lit(point({1, 2, 3}, -1), {1, 2, 3}));
  EXPECT_TRUE(is_lit(point({1, 2, 3}, infinity), {1e100, 0, 0}));
  EXPECT_TRUE(is_lit(point({1, 2, 3}, 1e20), {1e19, 0, 0}));
  EXPECT_TRUE(is_lit({.type = LightType::directional}, {1e100, 0, 0}));
}

TEST(IsLit, MeansPositiveAttenuation) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-2, 2);
  int lit = 0;
  for (int i = 0; i < 100000; ++i) {
    ViewLight light = spot({u(random), u(random), u(random)}, {0, 0, -1}, 2, u(random) / 2.2);
    if (i % 2) light.type = LightType::point;
    const dvec3 p(u(random), u(random), u(random));
    ASSERT_EQ(is_lit(light, p), attenuation(light, p, true) > 0);
    lit += is_lit(light, p);
  }
  EXPECT_GT(lit, 10000);
  EXPECT_LT(lit, 90000);
}

TEST(LitLights, AreListedInOrder) {
  const std::vector<ViewLight> lights = {point({0, 0, -1}, 2), point({9, 0, -1}, 2), point({1, 0, -1}, 2)};
  EXPECT_EQ(lit_lights(lights, {0.5, 0, -1}), (std::vector<uint32_t>{0, 2}));
}

// One pixel, 10 m away on the axis, three lights: the first and the last reach it.
class OnePixel : public testing::Test {
 protected:
  View view = perspective_view(1, 1, 1, 1, 1, infinity);
  std::vector<float> depth = {0.125f};  // 8 m
  std::vector<ViewLight> lights = {point({0, 0, -8}, 1), point({5, 0, -8}, 1), point({0, 0, -9}, 2)};
};

TEST_F(OnePixel, EveryLightListedLosesNone) {
  const LitPairs pairs = count_pairs(view, depth, lights, list_every_light(3));
  EXPECT_EQ(pairs.listed, 3u);
  EXPECT_EQ(pairs.lit, 2u);
  EXPECT_EQ(pairs.lost, 0u);
  EXPECT_EQ(pairs.wrong, 0u);
  EXPECT_EQ(pairs.listed_of_pixel, std::vector<uint32_t>{3});
  EXPECT_EQ(pairs.lit_of_pixel, std::vector<uint32_t>{2});
}

TEST_F(OnePixel, AMissingLightIsLost) {
  const ListedLights lists{{0}, {0}, {2}, {0, 1}};
  EXPECT_EQ(count_pairs(view, depth, lights, lists).lost, 1u);
}

TEST_F(OnePixel, AnEmptyListLosesAllThatIsLit) {
  const LitPairs pairs = count_pairs(view, depth, lights, {{0}, {0}, {0}, {}});
  EXPECT_EQ(pairs.listed, 0u);
  EXPECT_EQ(pairs.lost, 2u);
}

TEST_F(OnePixel, RepeatedAndUnknownLightsAreWrong) {
  const ListedLights lists{{0}, {0}, {5}, {0, 2, 0, 3, 0xffffffff}};
  const LitPairs pairs = count_pairs(view, depth, lights, lists);
  EXPECT_EQ(pairs.wrong, 3u);
  EXPECT_EQ(pairs.lost, 0u);
}

TEST_F(OnePixel, AListPastTheEndOfTheIndicesIsWrong) {
  const LitPairs pairs = count_pairs(view, depth, lights, {{0}, {1}, {4}, {0, 2}});
  EXPECT_EQ(pairs.wrong, 3u);  // entries 2, 3 and 4 of two
  EXPECT_EQ(pairs.lost, 1u);
  EXPECT_EQ(count_pairs(view, depth, lights, {{0}, {0xffffffff}, {2}, {0, 2}}).wrong, 2u);
}

TEST_F(OnePixel, ACellOutOfRangeIsWrongAndListsNothing) {
  const LitPairs pairs = count_pairs(view, depth, lights, {{7}, {0}, {3}, {0, 1, 2}});
  EXPECT_EQ(pairs.wrong, 1u);
  EXPECT_EQ(pairs.listed, 0u);
  EXPECT_EQ(pairs.lost, 2u);
}

TEST_F(OnePixel, NothingThereCountsNothing) {
  depth[0] = 0;
  const LitPairs pairs = count_pairs(view, depth, lights, list_every_light(3));
  EXPECT_EQ(pairs.listed, 0u);
  EXPECT_EQ(pairs.lit, 0u);
  EXPECT_EQ(pairs.listed_of_pixel, std::vector<uint32_t>{0});
}

TEST_F(OnePixel, LightZeroAloneIsALight) {
  lights.resize(1);
  EXPECT_EQ(count_pairs(view, depth, lights, list_every_light(1)).lost, 0u);
  EXPECT_EQ(count_pairs(view, depth, lights, {{0}, {0}, {0}, {}}).lost, 1u);
}

// Random depths, lights, cells and lists, counted independently one pair at a time.
void expect_naive_counts(const View& view, int light_count, uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> u(-1, 1);
  const size_t pixels = size_t(view.width) * view.height;
  std::vector<float> depth(pixels);
  for (float& d : depth) d = random() % 5 == 0 ? 0.0f : float(0.5 + 0.45 * u(random));
  std::vector<ViewLight> lights;
  for (int i = 0; i < light_count; ++i) {
    const dvec3 position(u(random), u(random), -1 - u(random));
    const double radius = i % 7 == 0 ? infinity : 0.5 + 0.5 * u(random);
    lights.push_back(i % 3 ? point(position, radius)
                           : spot(position, {0.6, 0, -0.8}, radius, 0.8 * u(random)));
    if (i == 5) lights.back().type = LightType::directional;
  }
  ListedLights lists;
  for (uint32_t cell = 0; cell < 11; ++cell) {
    lists.first.push_back(uint32_t(lists.indices.size()));
    for (int i = 0; i < light_count; ++i) {
      if (random() % 4) lists.indices.push_back(random() % 50 ? i : random() % (light_count + 1));
    }
    lists.count.push_back(uint32_t(lists.indices.size()) - lists.first.back());
  }
  for (size_t i = 0; i < pixels; ++i) lists.cell_of_pixel.push_back(random() % 11);

  LitPairs naive;
  for (size_t i = 0; i < pixels; ++i) {
    naive.listed_of_pixel.push_back(0);
    naive.lit_of_pixel.push_back(0);
    if (depth[i] == 0) continue;
    const dvec3 p = position_from_depth(view, int(i % view.width), int(i / view.width), depth[i]);
    const uint32_t cell = lists.cell_of_pixel[i];
    const auto begin = lists.indices.begin() + lists.first[cell], end = begin + lists.count[cell];
    naive.listed_of_pixel[i] = uint32_t(end - begin);
    naive.listed += end - begin;
    for (auto entry = begin; entry != end; ++entry) {
      naive.wrong += *entry >= lights.size() || std::find(begin, entry, *entry) != entry;
    }
    for (uint32_t light : lit_lights(lights, p)) {
      ++naive.lit;
      ++naive.lit_of_pixel[i];
      naive.lost += std::find(begin, end, light) == end;
    }
  }

  const LitPairs pairs = count_pairs(view, depth, lights, lists);
  EXPECT_EQ(pairs.listed_of_pixel, naive.listed_of_pixel);
  EXPECT_EQ(pairs.lit_of_pixel, naive.lit_of_pixel);
  EXPECT_EQ(pairs.listed, naive.listed);
  EXPECT_EQ(pairs.lit, naive.lit);
  EXPECT_EQ(pairs.lost, naive.lost);
  EXPECT_EQ(pairs.wrong, naive.wrong);
}

TEST(CountPairs, EqualsPlainLoopsAtAwkwardSizes) {
  for (uint32_t seed = 0; seed < 5; ++seed) {
    expect_naive_counts(perspective_view(1, 1, 1, 1, 0.5, infinity), 40, seed);
    expect_naive_counts(perspective_view(17, 9, 1, 0.6, 0.5, infinity, 0.2), 40, seed);
    expect_naive_counts(perspective_view(33, 31, 1, 1, 0.1, 4), 17, seed);
    expect_naive_counts(orthographic_view(17, 9, 1, 1, 0.1, 3), 40, seed);
    expect_naive_counts(orthographic_view(16, 16, 1, 1, 0.1, 3), 0, seed);
  }
}

}  // namespace
}  // namespace lightgrid::lab
