// Light volumes contain everything that their lights reach, for any light and view.
#include "passes/light_volumes/light_volumes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "plan/settings/surfaces.h"
#include "scene/random.h"

namespace lightgrid {
namespace {

constexpr int subpixel_bits = 8;

struct Plane {
  glm::dvec3 normal;
  double offset;  // dot(normal, p) <= offset inside
};

std::vector<Plane> planes_of(const LightMesh& mesh, const glm::dmat4& matrix) {
  std::vector<Plane> planes;
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    glm::dvec3 p[3];
    for (int k = 0; k < 3; ++k)
      p[k] = glm::dvec3(matrix * glm::dvec4(mesh.positions[mesh.indices[i + k]], 1));
    const glm::dvec3 normal = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
    planes.push_back({normal, glm::dot(normal, p[0])});
  }
  return planes;
}

// How far the light's sphere, or the part of it in the cone, extends along a direction.
double reach(const ViewLight& light, const glm::dvec3& direction) {
  const double at = glm::dot(direction, light.position);
  if (light.type == LightType::point || light.cos_outer < 0) return at + light.radius_m;
  const double along = glm::dot(direction, light.direction), angle = std::acos(std::clamp(along, -1.0, 1.0));
  const double outside = angle - std::acos(light.cos_outer);
  if (outside <= 0) return at + light.radius_m;
  return at + std::max(0.0, light.radius_m * std::cos(outside));
}

TEST(LightMeshes, AreClosedAndConvexAndTurnedOutwards) {
  const std::vector<LightMesh>& meshes = light_meshes();
  for (size_t m = 1; m < meshes.size(); ++m) {
    SCOPED_TRACE(m);
    std::map<std::pair<int, int>, int> edges;
    const auto& indices = meshes[m].indices;
    for (size_t i = 0; i < indices.size(); ++i) ++edges[{indices[i], indices[i % 3 == 2 ? i - 2 : i + 1]}];
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ((edges.count({edge.second, edge.first})), 1u);
    }
    for (const Plane& plane : planes_of(meshes[m], glm::dmat4(1))) {
      for (const glm::vec3& p : meshes[m].positions)
        EXPECT_LE(glm::dot(plane.normal, glm::dvec3(p)), plane.offset + 1e-6);
    }
  }
}

View any_view(Random& random) {
  Camera camera = look_at({0, 0, 0}, {0, 0, -1});
  const double kind = random.uniform();
  camera.near_m = std::exp(random.uniform(-5, 1));
  if (kind < 0.3) camera.far_m = camera.near_m * std::exp(random.uniform(1, 9));
  if (kind > 0.8) {
    camera.orthographic = true;
    camera.far_m = camera.near_m + 100;
    camera.half_height_m = 10;
  }
  camera.fov_y_rad = random.uniform() < 0.2 ? 2.97 : std::exp(random.uniform(-5, 0.6));
  return make_view(camera, 640, 360);
}

ViewLight any_volume_light(Random& random) {
  ViewLight light;
  light.type = random.uniform() < 0.5 ? LightType::point : LightType::spot;
  const double distance = std::exp(random.uniform(-4, 8));
  light.position = distance * glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1),
                                                        random.uniform(-1, 0.3)));
  light.direction =
      glm::normalize(glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
  light.radius_m = std::exp(random.uniform(-7, 9));
  const double narrow = std::exp(random.uniform(-8, 0.45));
  light.cos_outer = std::cos(random.uniform() < 0.2 ? random.uniform(1.5, std::numbers::pi) : narrow);
  return light;
}

// The least distance by which a volume's faces clear the light's reach, in units of float rounding of the
// numbers in shading. At least what culling's slack is derived from: docs/hard_cases.md#slack.
double clearance(const ViewLight& light, const LightVolume& volume) {
  const glm::dvec3 p = glm::abs(light.position);
  const double unit = 0x1p-24 * (p.x + p.y + p.z + light.radius_m);
  double least = std::numeric_limits<double>::infinity();
  for (const Plane& plane : planes_of(light_meshes()[volume.mesh], volume.view_from_mesh)) {
    least = std::min(least, (plane.offset - reach(light, plane.normal)) / unit);
  }
  return least;
}

// True if depth across the volume would round by more than a hundredth of the volume's content.
bool is_extreme(const View& view, const ViewLight& light) {
  const double farthest = glm::length(light.position) + 2 * light.radius_m;
  const bool cone = light.type == LightType::spot && light.cos_outer > 1e-6;
  const double sine = cone ? std::sin(std::acos(light.cos_outer - 1e-6)) : 1;
  return !view.orthographic &&
         32 * 0x1p-24 * farthest * farthest / view.near_m > 0.01 * light.radius_m * sine;
}

TEST(LightVolumes, ContainTheirBallsAndConesWithSlack) {
  Random random(4);
  size_t drawn = 0;
  for (int trial = 0; trial < 20'000; ++trial) {
    const View view = any_view(random);
    const ViewLight light = any_volume_light(random);
    for (const VolumeMeshes meshes :
         {VolumeMeshes::automatic, VolumeMeshes::icosahedron, VolumeMeshes::box}) {
      const auto volumes = light_volumes(view, {&light, 1}, meshes, subpixel_bits);
      if (volumes.empty()) continue;
      ++drawn;
      if (volumes[0].mesh == LightVolume::everything) {
        EXPECT_TRUE(is_extreme(view, light)) << "trial " << trial;
        continue;
      }
      ASSERT_GT(clearance(light, volumes[0]), 20) << "trial " << trial << " mesh " << volumes[0].mesh;
    }
  }
  EXPECT_GT(drawn, 20'000u);
}

// A point of the light that projects to a pixel is within the volume's pixels, and the light has a volume.
TEST(LightVolumes, AreThereWhereALightReachesAPixel) {
  Random random(5);
  size_t seen = 0;
  for (int trial = 0; trial < 200'000; ++trial) {
    const View view = any_view(random);
    const ViewLight light = any_volume_light(random);
    glm::dvec3 offset(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    offset *= light.radius_m / std::max(1.0, glm::length(offset));
    if (light.type == LightType::spot &&
        glm::dot(offset, light.direction) <= light.cos_outer * glm::length(offset))
      continue;
    const glm::dvec4 clip = view.clip_from_view * glm::dvec4(light.position + offset, 1);
    if (!(clip.z <= clip.w && clip.z >= 0 && std::abs(clip.x) < clip.w && std::abs(clip.y) < clip.w))
      continue;
    ++seen;
    const auto volumes = light_volumes(view, {&light, 1}, VolumeMeshes::automatic, subpixel_bits);
    ASSERT_EQ(volumes.size(), 1u) << "trial " << trial;
    const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(view.width, view.height);
    for (int k = 0; k < 2; ++k) {
      ASSERT_LE(volumes[0].low_px[k], pixel[k]) << "trial " << trial;
      ASSERT_GE(volumes[0].high_px[k], pixel[k]) << "trial " << trial;
    }
  }
  EXPECT_GT(seen, 5'000u);
}

View plain_view() { return make_view(look_at({0, 0, 0}, {0, 0, -1}), 640, 360); }

std::vector<LightVolume> volumes_of(const ViewLight& light) {
  return light_volumes(plain_view(), {&light, 1}, VolumeMeshes::automatic, subpixel_bits);
}

ViewLight point_at(const glm::dvec3& position, double radius) {
  return {.type = LightType::point, .position = position, .radius_m = radius};
}

TEST(LightVolumes, AreNoneOfLightsThatReachNothingInView) {
  EXPECT_TRUE(volumes_of(point_at({0, 0, 3}, 2)).empty()) << "behind";
  EXPECT_TRUE(volumes_of(point_at({50, 0, -3}, 2)).empty()) << "to the side";
  EXPECT_TRUE(volumes_of(point_at({0, 0, -3}, 0)).empty());
  EXPECT_TRUE(volumes_of(point_at({0, 0, -3}, -1)).empty());
  ViewLight away = point_at({0, 0, 0.5}, 5);
  away.type = LightType::spot;
  away.direction = {0, 0, 1};
  away.cos_outer = 0.7;
  EXPECT_TRUE(volumes_of(away).empty()) << "shines away";
}

TEST(LightVolumes, TellWhetherTheNearPlaneCutsThem) {
  EXPECT_FALSE(volumes_of(point_at({0, 0, -3}, 1))[0].crosses_near);
  EXPECT_TRUE(volumes_of(point_at({0, 0, -3}, 2.95))[0].crosses_near);
  EXPECT_TRUE(volumes_of(point_at({0, 0, 0}, 1))[0].crosses_near);
}

TEST(LightVolumes, AreCloseWhereNothingIsExtreme) {
  for (const double radius : {0.1, 1.0, 4.0}) {
    EXPECT_LT(volumes_of(point_at({0.5, 0, -20}, radius))[0].radius, 1.3 * radius);
  }
  const auto large = volumes_of(point_at({0, 0, -6}, 4));
  EXPECT_LT(large[0].radius, 1.04 * 4) << "more faces where it is large";
}

TEST(LightVolumes, OfLightsWithoutEndAreEverything) {
  for (const double radius : {std::numeric_limits<double>::infinity(), 1e20, 1e300}) {
    const auto volumes = volumes_of(point_at({0, 0, -3}, radius));
    ASSERT_EQ(volumes.size(), 1u);
    EXPECT_EQ(volumes[0].mesh, LightVolume::everything);
    EXPECT_TRUE(volumes[0].crosses_near);
  }
}

}  // namespace
}  // namespace lightgrid
