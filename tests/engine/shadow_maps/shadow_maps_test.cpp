// Shadow maps against a card over a floor, solved by hand, and other small scenes.
#include <gtest/gtest.h>

#include "shadow_maps/card_over_floor.h"

namespace lightgrid {
namespace {

class OneCard : public ::testing::TestWithParam<std::tuple<LightType, int, int>> {};

TEST_P(OneCard, OnlyPointsWithinATexelOfTheEdgeAreWrong) {
  const auto [type, bits, taps] = GetParam();
  double last = HUGE_VAL;
  for (const int size : {64, 256, 1024}) {
    const ShadowMapOptions options{.size = size, .bits = bits, .taps = taps, .cascades = 1};
    const Light light = lamp(type);
    const Wrong wrong = wrong_points(light, options);
    EXPECT_LE(wrong.furthest_m, max_wrong_m(light, options)) << size;
    EXPECT_LT(wrong.leaked + wrong.acned, last) << size;
    last = wrong.leaked + wrong.acned;
  }
}

INSTANTIATE_TEST_SUITE_P(ShadowMaps, OneCard,
                         ::testing::Combine(::testing::Values(LightType::point, LightType::spot,
                                                              LightType::directional),
                                            ::testing::Values(16, 24, 32), ::testing::Values(1, 3, 5)));

// A step of 16 bits is then 3 cm, and the floor's distances are rounded to either side of it.
TEST(ShadowMaps, TheFormatsStepIsInTheBias) {
  Light light = lamp(LightType::point);
  light.radius_m = 2000;
  const ShadowMapOptions options{.size = 1024, .bits = 16};
  const Wrong wrong = wrong_points(light, options);
  EXPECT_GT(wrong.leaked + wrong.acned, 0);
  EXPECT_LE(wrong.furthest_m, std::sqrt(0.5) * 2 * light_height_m / options.size * 1.001);
}

// The wall x = 1 passes beside the light and above it: half of what the faces see of it lies behind them.
TEST(ShadowMaps, AWallThatCrossesTheLightsPlanesHidesAllBehindIt) {
  const std::vector<glm::vec3> corners{{-8, 0, -8}, {8, 0, -8}, {8, 0, 8}, {-8, 0, 8},
                                       {1, 0, -9},  {1, 9, -9}, {1, 9, 9}, {1, 0, 9}};
  const RayScene rays = scene_of(corners, {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7});
  const Light light = lamp(LightType::point);
  const ShadowMapOptions options{.size = 256};
  ShadowMaps maps(device(), programs(), options);
  maps.draw(rays, plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options));
  const std::vector<RayPoint> points = floor_points();
  const std::vector<uint8_t> taps = taps_at(maps, rays, points);
  const double texel_m = 2 * light_height_m / options.size;
  for (size_t i = 0; i < points.size(); ++i) {
    const float x = points[i].position.x;
    if (std::abs(x - 1) < texel_m) continue;
    ASSERT_EQ(taps[i], x > 1 ? 1 : 0) << x << ' ' << points[i].position.z;
  }
}

TEST(ShadowCascades, EachHoldsItsPartOfTheFrustum) {
  const Light sun = lamp(LightType::directional);
  const ShadowMapOptions options{.size = 64, .taps = 5};
  const View view = view_from(5);
  const std::vector<ShadowFace> faces = cascades_of(sun, view, glm::dvec3(0), room, 64, options);
  ASSERT_EQ(faces.size(), 4u);
  const double tan_x = 1 / view.clip_from_view[0][0], tan_y = 1 / view.clip_from_view[1][1];
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  for (double distance = view.near_m; distance < glm::length(room.max - room.min); distance *= 1.05) {
    for (const double x : {-1.0, 0.0, 1.0}) {
      for (const double y : {-1.0, 0.0, 1.0}) {
        const glm::dvec3 p = view.eye + world_from_view * glm::dvec3(x * tan_x, y * tan_y, -1) * distance;
        bool held = false;
        for (const ShadowFace& f : faces) {
          held |= holds_taps(f, p, options.taps);
        }
        EXPECT_TRUE(held) << distance << ' ' << x << ' ' << y;
      }
    }
  }
  for (size_t i = 1; i < faces.size(); ++i) EXPECT_GT(faces[i].extent, faces[i - 1].extent);
}

// All of the room is nearer to the eye's light than the light is to the room.
TEST(ShadowAtlas, ALightWithoutRangeReachesTheRoomFromAfar) {
  Light light = lamp(LightType::spot);
  light.position = {0, 300, 0};
  light.outer_cone_rad = 0.1f;
  light.radius_m = std::numeric_limits<float>::infinity();
  const ShadowMapOptions options{.size = 1024};
  const RayScene rays = card_over_floor();
  ShadowMaps maps(device(), programs(), options);
  maps.draw(rays, plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options));
  const RayPoint below{.position = {0, 0, 0.1f}, .own = 0};
  EXPECT_EQ(taps_at(maps, rays, std::vector<RayPoint>(16, below)), std::vector<uint8_t>(16, 1));
}

TEST(ShadowAtlas, SizesFollowTheShareOfTheScreenAndNoLightIsLeftOut) {
  std::vector<Light> lights(3, lamp(LightType::point));
  lights[0].radius_m = 1;
  lights[1].radius_m = 1;
  lights[2].radius_m = 1;
  lights[0].position = {0, 0, 0};
  lights[1].position = {0, 0, -15};
  lights[2].position = {0, 0, -3000};
  const View view = view_from(5);
  const ShadowAtlas atlas = plan_shadow_atlas(lights, view, glm::dvec3(0), room, {.size = 256});
  ASSERT_EQ(atlas.faces.size(), 18u);
  EXPECT_EQ(atlas.faces[0].size, 256u);
  EXPECT_EQ(atlas.faces[6].size, 64u);   // four times as far
  EXPECT_EQ(atlas.faces[12].size, 16u);  // the least
  EXPECT_EQ(atlas.texels, 6u * (256 * 256 + 64 * 64 + 16 * 16));

  const ShadowAtlas halved =
      plan_shadow_atlas(lights, view, glm::dvec3(0), room, {.size = 256, .max_bytes = 500'000});
  EXPECT_EQ(halved.halvings, 1);
  EXPECT_EQ(halved.faces[0].size, 128u);
  EXPECT_EQ(halved.faces[6].size, 32u);
  EXPECT_EQ(halved.faces[12].size, 16u);
}

}  // namespace
}  // namespace lightgrid
