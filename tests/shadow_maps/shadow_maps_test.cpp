// A card over a floor, solved by hand: a light at the height h, above the middle of a square card of half
// side s at the height c, sees the points of the floor outside of a square of half side s h / (h - c). The
// card is turned, so that no edge follows a row of texels. The sun's rays are parallel: its shadow is a
// square of half side s, moved along them.
#include "shadow_maps/shadow_maps.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scene/camera.h"

namespace lightgrid {
namespace {

constexpr double light_height_m = 3, card_height_m = 1, card_half_m = 0.5;
constexpr double card_turn_rad = 0.3;
const WorldBox room{{-8, 0, -8}, {8, 4, 8}};
constexpr double shadow_half_m = card_half_m * light_height_m / (light_height_m - card_height_m);

ClDevice& device() {
  static ClDevice device;
  return device;
}
ProgramCache& programs() {
  static ProgramCache programs(device());
  return programs;
}

glm::vec2 turned(const glm::vec2& p, double angle_rad) {
  const float c = float(std::cos(angle_rad)), s = float(std::sin(angle_rad));
  return {c * p.x - s * p.y, s * p.x + c * p.y};
}

RayScene scene_of(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
  RayScene rays(device(), programs(), {.origin = glm::dvec3(0)});
  const RayMesh mesh{positions, indices};
  const RayInstance instance{};
  rays.set_meshes({&mesh, 1}), rays.set_instances({&instance, 1});
  return rays;
}

// Two triangles each: the floor (numbers 0 and 1), then the card.
RayScene card_over_floor() {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  for (const glm::vec2 quad : {glm::vec2(8, 0), glm::vec2(card_half_m, card_height_m)}) {
    const uint32_t first = uint32_t(positions.size());
    for (const glm::vec2 corner : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
      const glm::vec2 at = turned(corner * quad.x, quad.y > 0 ? card_turn_rad : 0);
      positions.push_back({at.x, quad.y, at.y});
    }
    for (const uint32_t k : {0, 2, 1, 0, 3, 2}) indices.push_back(first + k);
  }
  return scene_of(positions, indices);
}

Light lamp(LightType type) {
  Light light;
  light.type = type;
  light.position = {0, light_height_m, 0}, light.direction = {0, -1, 0};
  light.radius_m = 8, light.outer_cone_rad = 1.0f;
  if (is_directional(light)) light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
  return light;
}

View view_from(double distance_m) { return make_view(look_at({0, 0.5, distance_m}, {0, 0, 0}), 640, 480); }

// Metres from a point of the floor to the shadow's edge, above 0 inside.
double inside_m(const Light& light, const glm::vec3& point) {
  const bool sun = is_directional(light);
  const glm::vec3 moved = sun ? point + light.direction * (float(card_height_m) / light.direction.y) : point;
  const glm::vec2 p = turned({moved.x, moved.z}, -card_turn_rad);
  return (sun ? card_half_m : shadow_half_m) - std::max(std::abs(p.x), std::abs(p.y));
}

// Of the floor, 3 m each way in steps of 2.7 cm.
std::vector<RayPoint> floor_points() {
  std::vector<RayPoint> points;
  for (float x = -3; x < 3; x += 0.027f)
    for (float z = -3; z < 3; z += 0.027f) points.push_back({.position = {x, 0, z}, .own = x > z ? 0 : 1});
  points.resize(points.size() / 16 * 16);
  return points;
}

std::vector<uint8_t> taps_at(ShadowMaps& maps, const RayScene& rays, const std::vector<RayPoint>& points) {
  std::vector<RayPacket> packets;
  for (uint32_t block = 0; block < points.size() / 16; ++block) packets.push_back({block, 0});
  return maps.look_up(rays, points, packets);
}

struct Wrong {
  int leaked = 0, acned = 0;
  double furthest_m = 0;  // from the shadow's edge
};

Wrong wrong_points(const Light& light, const ShadowMapOptions& options) {
  const RayScene rays = card_over_floor();
  ShadowMaps maps(device(), programs(), options);
  maps.draw(rays, plan_shadow_atlas({&light, 1}, view_from(5), rays.origin(), room, options));
  const std::vector<RayPoint> points = floor_points();
  const std::vector<uint8_t> taps = taps_at(maps, rays, points);
  const int most = options.taps * options.taps;
  Wrong wrong;
  for (size_t i = 0; i < points.size(); ++i) {
    const double inside = inside_m(light, points[i].position);
    const bool leaked = inside > 0 && taps[i] < most, acned = inside < 0 && taps[i] > 0;
    wrong.leaked += leaked, wrong.acned += acned;
    if (leaked || acned) wrong.furthest_m = std::max(wrong.furthest_m, std::abs(inside));
  }
  return wrong;
}

class OneCard : public ::testing::TestWithParam<std::tuple<LightType, int, int>> {};

// A texel's centre is at most half a texel away along either side, and each tap of a filter a texel more.
TEST_P(OneCard, OnlyPointsWithinATexelOfTheEdgeAreWrong) {
  const auto [type, bits, taps] = GetParam();
  double last = HUGE_VAL;
  for (const int size : {64, 256, 1024}) {
    const ShadowMapOptions options{.size = size, .bits = bits, .taps = taps, .cascades = 1};
    const Light light = lamp(type);
    const ShadowAtlas atlas = plan_shadow_atlas({&light, 1}, view_from(5), glm::dvec3(0), room, options);
    const double texel_m = 2 * double(atlas.faces[0].extent) / size *
                           (is_directional(light) ? 1 / std::abs(light.direction.y) : light_height_m);
    const Wrong wrong = wrong_points(light, options);
    EXPECT_LE(wrong.furthest_m, (0.5 + taps / 2) * std::sqrt(2) * texel_m * 1.001) << size;
    EXPECT_LT(wrong.leaked + wrong.acned, last) << size;
    last = wrong.leaked + wrong.acned;
  }
}

INSTANTIATE_TEST_SUITE_P(
    ShadowMaps, OneCard,
    ::testing::Combine(::testing::Values(LightType::point, LightType::spot, LightType::directional),
                       ::testing::Values(16, 24, 32),
                       ::testing::Values(1, 3, 5)));

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

// A camera that goes forward and turns.
View view_of_frame(int frame) {
  const double t = frame / 300.0;
  return make_view(look_at({0.3 * t, 1 + 0.2 * t, 5 - 2 * t}, {0.5 * t, 0, -0.3 * t}), 640, 480);
}

TEST(ShadowCascades, AnswersOfStillPointsStayWhileTheCameraMoves) {
  const RayScene rays = card_over_floor();
  const Light sun = lamp(LightType::directional);
  const std::vector<RayPoint> points = floor_points();
  const ShadowMapOptions options{.size = 128, .cascades = 1};
  ShadowMaps maps(device(), programs(), options);
  std::vector<uint8_t> before;
  size_t changed = 0, dark = 0;
  for (int frame = 0; frame < 300; ++frame) {
    maps.draw(rays, plan_shadow_atlas({&sun, 1}, view_of_frame(frame), rays.origin(), room, options));
    const std::vector<uint8_t> taps = taps_at(maps, rays, points);
    for (size_t i = 0; i < taps.size(); ++i) changed += frame > 0 && taps[i] != before[i], dark += taps[i];
    before = taps;
  }
  EXPECT_GT(dark, 300 * points.size() / 100);
  EXPECT_EQ(changed, 0u);
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
          const glm::vec3 to = glm::vec3(p) - glm::vec3(f.from[0], f.from[1], f.from[2]);
          const float most = f.extent * float(64 - 2 * 2) / 64;
          held |= std::abs(glm::dot(to, glm::vec3(f.right[0], f.right[1], f.right[2]))) < most &&
                  std::abs(glm::dot(to, glm::vec3(f.up[0], f.up[1], f.up[2]))) < most;
        }
        EXPECT_TRUE(held) << distance << ' ' << x << ' ' << y;
      }
    }
  }
  for (size_t i = 1; i < faces.size(); ++i) EXPECT_GT(faces[i].extent, faces[i - 1].extent);
}

TEST(ShadowAtlas, SizesFollowTheShareOfTheScreenAndNoLightIsLeftOut) {
  std::vector<Light> lights(3, lamp(LightType::point));
  lights[0].radius_m = 1, lights[1].radius_m = 1, lights[2].radius_m = 1;
  lights[0].position = {0, 0, 0}, lights[1].position = {0, 0, -15}, lights[2].position = {0, 0, -3000};
  const View view = view_from(5);
  const ShadowAtlas atlas = plan_shadow_atlas(lights, view, glm::dvec3(0), room, {.size = 256});
  ASSERT_EQ(atlas.faces.size(), 18u);
  EXPECT_EQ(atlas.faces[0].size, 256u);
  EXPECT_EQ(atlas.faces[6].size, 64u);   // four times as far
  EXPECT_EQ(atlas.faces[12].size, 16u);  // the least
  EXPECT_EQ(atlas.texels, 6u * (256 * 256 + 64 * 64 + 16 * 16));

  const ShadowAtlas halved =
      plan_shadow_atlas(lights, view, glm::dvec3(0), room, {.size = 256, .most_bytes = 500'000});
  EXPECT_EQ(halved.halvings, 1);
  EXPECT_EQ(halved.faces[0].size, 128u);
  EXPECT_EQ(halved.faces[6].size, 32u);
  EXPECT_EQ(halved.faces[12].size, 16u);
}

}  // namespace
}  // namespace lightgrid
