// Measures how shadows of cascades swim while the camera moves: the temporal error of points of a still
// scene. A point's answer is wrong in time where it flips from a frame to the next, in both of which the eye
// sees the point, though the truth, by exact rays, does not.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "shadow_maps/card_over_floor.h"
#include "support/long_tests.h"

namespace lightgrid {
namespace {

using glm::dvec3;

constexpr int width = 160, height = 90;

// A floor of 40 m and 36 posts on it, with points on all sides.
struct Posts {
  std::vector<glm::vec3> corners;
  std::vector<uint32_t> indices;
  std::vector<RayPoint> points;

  Posts() {
    add_side({-20, 0, -20}, {40, 0, 0}, {0, 0, 40}, 96);
    for (int i = 0; i < 36; ++i) {
      const glm::vec3 at(5.5f * float(i % 6) - 14, 0, 5.5f * float(i / 6) - 14);
      const float x = 0.2f + 0.05f * float(i % 5), z = 0.7f - 0.1f * float(i % 4),
                  y = 1 + 0.3f * float(i % 7);
      const glm::vec3 right(x, 0, 0), up(0, y, 0), ahead(0, 0, z);
      for (const glm::vec3& from : {glm::vec3(0), ahead}) add_side(at + from, right, up, 8);
      for (const glm::vec3& from : {glm::vec3(0), right}) add_side(at + from, ahead, up, 8);
      add_side(at + up, right, ahead, 8);
    }
    points.resize(points.size() / 16 * 16);
  }

 private:
  void add_side(const glm::vec3& at, const glm::vec3& a, const glm::vec3& b, int across) {
    const uint32_t k = uint32_t(corners.size());
    for (const glm::vec3& corner : {at, at + a, at + b, at + a + b}) corners.push_back(corner);
    const int first = int(indices.size() / 3);
    for (const uint32_t corner : {k, k + 1, k + 2, k + 1, k + 3, k + 2}) indices.push_back(corner);
    for (int i = 0; i < across * across; ++i) {
      const float s = (float(i % across) + 0.37f) / float(across),
                  t = (float(i / across) + 0.61f) / float(across);
      points.push_back({.position = at + s * a + t * b, .own = s + t < 1 ? first : first + 1});
    }
  }
};

// Goes forward, sways and looks around, at about walking pace.
View view_of_frame(int frame) {
  const double t = frame / 300.0, angle = 0.8 * std::sin(5 * t);
  const dvec3 eye(2 * std::sin(7 * t), 1.6 + 0.1 * std::sin(40 * t), 14 - 12 * t);
  const dvec3 ahead(std::sin(angle), -0.15, -std::cos(angle));
  return make_view(look_at(eye, eye + ahead), width, height);
}

// The stable ones, or those whose squares are where the frustum's parts are: texels of a thousandth.
ShadowAtlas cascades_at(const Light& sun, const View& view, const WorldBox& box,
                        const ShadowMapOptions& options, bool stable) {
  ShadowAtlas atlas = plan_shadow_atlas({&sun, 1}, view, dvec3(0), box, options);
  const std::vector<ShadowFace> fine = cascades_of(sun, view, dvec3(0), box, 1024 * options.size, options);
  for (size_t i = 0; !stable && i < fine.size(); ++i) std::ranges::copy(fine[i].from, atlas.faces[i].from);
  return atlas;
}

struct Temporal {
  size_t seen = 0;     // in two frames
  size_t flipped = 0;  // those that flipped
  size_t swam = 0;     // those that flipped in the same cascade
  size_t wrong = 0;    // seen points that differ from the truth
  double per_million(size_t points) const { return 1e6 * double(points) / double(seen); }
};

size_t cascade_of(const std::vector<ShadowFace>& faces, const dvec3& point) {
  return size_t(std::ranges::find_if(faces, [&](const ShadowFace& f) { return holds_taps(f, point, 1); }) -
                faces.begin());
}

std::vector<bool> seen_from(RayScene& rays, const View& view, const std::vector<RayPoint>& points) {
  std::vector<RayPacket> packets;
  for (uint32_t block = 0; block < points.size() / 16; ++block) packets.push_back({block, 0});
  const RayLight eye(view.eye, 1);
  const std::vector<uint32_t> hidden = rays.occlusion(points, {&eye, 1}, packets);
  std::vector<bool> seen;
  for (size_t i = 0; i < points.size(); ++i) {
    const glm::dvec4 p = view.clip_from_view * (view.view_from_world * glm::dvec4(points[i].position, 1));
    seen.push_back(!(hidden[i / 16] >> i % 16 & 1) && p.w > 0 && std::abs(p.x) < p.w && std::abs(p.y) < p.w);
  }
  return seen;
}

Temporal temporal_error(const ShadowMapOptions& options, bool stable, int frames) {
  const Posts posts;
  RayScene rays = scene_of(posts.corners, posts.indices);
  const WorldBox box{dvec3(-20, 0, -20), dvec3(20, 3, 20)};
  Light sun = lamp(LightType::directional);
  sun.direction = glm::normalize(glm::vec3(0.5f, -1, 0.3f));
  std::vector<RayPacket> packets;
  for (uint32_t block = 0; block < posts.points.size() / 16; ++block) packets.push_back({block, 0});
  const RayLight to_sun(-dvec3(sun.direction), 0);
  const std::vector<uint32_t> truth = rays.occlusion(posts.points, {&to_sun, 1}, packets);
  ShadowMaps maps(device(), programs(), options);
  Temporal t;
  std::vector<bool> seen_before;
  std::vector<uint8_t> before;
  std::vector<ShadowFace> faces_before;
  for (int frame = 0; frame < frames; ++frame) {
    const View view = view_of_frame(frame);
    const ShadowAtlas atlas = cascades_at(sun, view, box, options, stable);
    maps.draw(rays, atlas);
    const std::vector<bool> seen = seen_from(rays, view, posts.points);
    const std::vector<uint8_t> taps = taps_at(maps, rays, posts.points);
    for (size_t i = 0; frame > 0 && i < taps.size(); ++i) {
      if (!seen[i] || !seen_before[i]) continue;
      const bool flipped = taps[i] != before[i];
      const dvec3 at(posts.points[i].position);
      ++t.seen;
      t.flipped += flipped;
      t.wrong += taps[i] != (truth[i / 16] >> i % 16 & 1);
      t.swam += flipped && cascade_of(atlas.faces, at) == cascade_of(faces_before, at);
    }
    seen_before = seen;
    before = taps;
    faces_before = atlas.faces;
  }
  return t;
}

// The truth stands still here.
TEST(ShadowCascades, ShadowsDoNotSwim) {
  for (const int cascades : {1, 4}) {
    const ShadowMapOptions options{.size = 512, .cascades = cascades};
    const int frames = long_tests() ? 300 : 40;
    const Temporal stable = temporal_error(options, true, frames),
                   moved = temporal_error(options, false, frames);
    for (const Temporal* t : {&stable, &moved}) {
      fmt::print(
          "{} cascades, {}: {} points seen in two frames; of a million {:.0f} flip, {:.0f} in one cascade; "
          "{:.2f} % are wrong\n",
          cascades, t == &stable ? "stable" : "moved by parts of a texel", t->seen,
          t->per_million(t->flipped), t->per_million(t->swam), 1e-4 * t->per_million(t->wrong));
    }
    EXPECT_GT(stable.seen, size_t(frames) * 4000);
    EXPECT_EQ(stable.swam, 0u);
    EXPECT_GT(moved.swam, 20 * stable.flipped);
    EXPECT_GT(moved.swam, moved.seen / 200);
  }
}

}  // namespace
}  // namespace lightgrid
