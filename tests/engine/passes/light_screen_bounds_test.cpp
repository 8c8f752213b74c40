// Rectangles and depth intervals of lights contain every pixel that the light reaches, and little more.
#include "passes/light_volumes/volume_draws.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "scene/random.h"

namespace lightgrid {
namespace {

constexpr int width = 320, height = 200;

View random_view(Random& random) {
  Camera camera;
  camera.near_m = 0.1;
  camera.orthographic = random.uniform() < 0.25f;
  if (camera.orthographic || random.uniform() < 0.5f) camera.far_m = 50;
  camera.half_height_m = 4;
  camera.fov_y_rad = random.uniform(0.2f, 2.6f);
  View view = make_view(camera, width, height);
  if (!camera.orthographic) {  // off the centre
    view.clip_from_view[2][0] = random.uniform(-0.5f, 0.5f);
    view.clip_from_view[2][1] = random.uniform(-0.5f, 0.5f);
  }
  return view;
}

glm::dvec3 on_sphere(Random& random) {
  const double z = random.uniform(-1, 1), turn = random.uniform(0, 6.2831853f), r = std::sqrt(1 - z * z);
  return {r * std::cos(turn), r * std::sin(turn), z};
}

// Light and bounds where only the sphere limits.
struct Trial {
  View view;
  ViewLight light;
  ScreenBounds bounds;
};

Trial random_trial(Random& random) {
  Trial t{random_view(random), {}, {}};
  t.light.position = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-12, 2)};
  t.light.radius_m = random.uniform(0.05f, 3);
  LightVolume volume{};
  volume.bounds = bounds_of(t.light);
  volume.center = t.light.position;
  volume.radius = 1e9;
  volume.first = {0, 0};
  volume.end = {width, height};
  t.bounds = screen_bounds(t.view, volume);
  return t;
}

// Pixel coordinates and depth; none in front of the near plane.
std::optional<glm::dvec3> seen(const View& view, const glm::dvec3& p) {
  if (-p.z < view.near_m || -p.z > view.far_m) return {};
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(p, 1);
  return glm::dvec3((clip.x / clip.w * 0.5 + 0.5) * width, (clip.y / clip.w * 0.5 + 0.5) * height,
                    clip.z / clip.w);
}

TEST(LightScreenBounds, HoldEveryPixelAndDepthOfTheBall) {
  Random random(3);
  int inside = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const Trial t = random_trial(random);
    for (int i = 0; i < 100; ++i) {
      const auto p = seen(t.view, t.light.position + on_sphere(random) * t.light.radius_m);
      if (!p || p->x < 0 || p->y < 0 || p->x >= width || p->y >= height) continue;
      ++inside;
      ASSERT_GE(std::floor(p->x), t.bounds.first.x) << trial;
      ASSERT_GE(std::floor(p->y), t.bounds.first.y);
      ASSERT_LT(std::floor(p->x), t.bounds.end.x);
      ASSERT_LT(std::floor(p->y), t.bounds.end.y);
      ASSERT_GE(float(p->z), t.bounds.depth.x);
      ASSERT_LE(float(p->z), t.bounds.depth.y);
    }
  }
  EXPECT_GT(inside, 50000);
}

TEST(LightScreenBounds, AreThoseOfTheTangents) {
  Random random(4);
  int looked_at = 0;
  for (int trial = 0; trial < 3000 && looked_at < 150; ++trial) {
    const Trial t = random_trial(random);
    if (-t.light.position.z - t.light.radius_m < t.view.near_m) continue;
    glm::dvec2 low(1e9), high(-1e9);
    for (int i = 0; i < 20000; ++i) {
      const auto p = seen(t.view, t.light.position + on_sphere(random) * t.light.radius_m);
      if (p) {
        low = glm::min(low, glm::dvec2(*p));
        high = glm::max(high, glm::dvec2(*p));
      }
    }
    if (low.x < 0 || low.y < 0 || high.x > width || high.y > height) continue;
    ++looked_at;
    // The samples end a hundredth short of the tangents, slack is two hundredths, and pixels are whole.
    const glm::dvec2 more = 0.03 * (high - low) + 3.0;
    for (int axis = 0; axis < 2; ++axis) {
      ASSERT_GE(t.bounds.first[axis], low[axis] - more[axis]) << trial;
      ASSERT_LE(t.bounds.end[axis], high[axis] + more[axis]) << trial;
    }
  }
  EXPECT_GE(looked_at, 50);
}

TEST(LightScreenBounds, OfALightWithoutEndAreTheVolumes) {
  ViewLight light;
  light.radius_m = std::numeric_limits<double>::infinity();
  LightVolume volume{};
  volume.bounds = bounds_of(light);
  volume.first = {3, 4};
  volume.end = {50, 60};
  Random random(5);
  const ScreenBounds bounds = screen_bounds(random_view(random), volume);
  EXPECT_EQ(bounds.first, volume.first);
  EXPECT_EQ(bounds.end, volume.end);
  EXPECT_EQ(bounds.depth, glm::vec2(0, 1));
}

}  // namespace
}  // namespace lightgrid
