// A point is in as many prisms of a light's shadow volume as triangles hide it, whatever the triangles are.
#include "passes/shadows/caster_volumes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "plan/settings/surfaces.h"
#include "renderer/gpu_scene.h"
#include "scene/blended_casters.h"
#include "scene/random.h"
#include "scenes/compose.h"
#include "scenes/shapes.h"
#include "support/devices.h"

namespace lightgrid {
namespace {

using glm::dvec3;

Scene scene_of(Mesh mesh, const glm::dmat4& world_from_object = glm::dmat4(1)) {
  Scene scene;
  mesh.material = add_material(scene, "card", {1, 1, 1}, 0, 1);
  add_instance(scene, "card", add_mesh(scene, std::move(mesh)), world_from_object);
  return scene;
}

CasterVolumes volumes_of(const Scene& scene, const CastingLight& light) {
  GpuScene gpu(test_devices(), scene);
  return caster_volumes(scene, *gpu.in_rays(TexelLayout::packed, BlendedCasters::none), {&light, 1});
}

Mesh mesh_of(std::vector<glm::vec3> positions, std::vector<uint32_t> indices) {
  Mesh mesh;
  mesh.positions = std::move(positions);
  mesh.indices = std::move(indices);
  mesh.normals.resize(mesh.positions.size(), {0, 0, 1});
  for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
  return mesh;
}

size_t triangles_of(const Scene& scene, const CastingLight& light) {
  return volumes_of(scene, light).indices.size() / 3;
}

TEST(CasterVolumes, ByHand) {
  const std::vector<glm::vec3> corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};
  const CastingLight light{{0.3, 0.3, 5}, 10};
  // Two caps, and two triangles a side.
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2})), light), 2u + 6u);
  // The side that both share cancels, whichever way they are wound.
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2, 0, 2, 3})), light), 4u + 8u);
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2, 0, 3, 2})), light), 4u + 8u);
  // A roof of two triangles over one edge, has no side there, or two if the light sees both ends.
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2, 0, 1, 4})), {{0.3, 0.5, 0.2}, 10}), 4u + 8u);
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2, 0, 1, 4})), {{0.3, -5, 0.5}, 10}), 4u + 8u + 4u);
  // Out of range, without one, and edge-on.
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2})), {{0.3, 0.3, 5}, 4}), 0u);
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2})), {{0.3, 0.3, 5}, 0}), 0u);
  EXPECT_EQ(triangles_of(scene_of(mesh_of(corners, {0, 1, 2})), {{5, 0.3, 0}, 10}), 0u);
}

// How often a ray from p along d leaves the triangle's front, less how often it enters it.
int crossing(const dvec3& p, const dvec3& d, const dvec3& a, const dvec3& b, const dvec3& c) {
  const dvec3 n = glm::cross(b - a, c - a);
  const double facing = glm::dot(n, d), t = glm::dot(n, a - p) / facing;
  if (!(t > 0)) return 0;
  const dvec3 at = p + t * d;
  if (glm::dot(glm::cross(b - a, at - a), n) < 0 || glm::dot(glm::cross(c - b, at - b), n) < 0 ||
      glm::dot(glm::cross(a - c, at - c), n) < 0)
    return 0;
  return facing > 0 ? 1 : -1;
}

// Soups, a grid whose triangles share edges, and a mirrored ball; lights in and about them.
TEST(CasterVolumes, HoldPointsAsOftenAsTrianglesHideThem) {
  Random random(11);
  const auto somewhere = [&](double extent) {
    return dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)) * extent;
  };
  int hidden = 0, points = 0;
  for (int trial = 0; trial < 24; ++trial) {
    Mesh mesh;
    if (trial % 3 == 0) {
      std::vector<glm::vec3> positions;
      std::vector<uint32_t> indices;
      for (int i = 0; i < 12; ++i) positions.emplace_back(somewhere(1));
      for (int i = 0; i < 60; ++i) indices.push_back(uint32_t(random.next() % 12));
      mesh = mesh_of(positions, indices);
    } else if (trial % 3 == 1) {
      shapes::add_quad(mesh, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0.4f}, 4, 3);
    } else {
      shapes::add_sphere(mesh, {0, 0, 0}, 0.6f, 6);
    }
    mesh.bounds = {};
    for (const glm::vec3& p : mesh.positions) mesh.bounds.add(p);
    const glm::dmat4 placed_at =
        trial % 2 ? glm::dmat4(1)
                  : placed({0.1, 0, 0.2}, 30) * glm::dmat4(glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, 1));
    const Scene scene = scene_of(mesh, placed_at);
    const CastingLight light{somewhere(1.5), 20};
    const CasterVolumes volumes = volumes_of(scene, light);
    const Mesh& own = scene.meshes[0];
    const auto corner = [&](uint32_t index) {
      return dvec3(placed_at * glm::dvec4(own.positions[own.indices[index]], 1));
    };
    const auto end = [&](uint32_t index) {  // infinity is far enough
      const dvec3 p = corner(index / 2);
      return index % 2 ? p + 1e7 * (p - light.position) : p;
    };
    for (int k = 0; k < 50; ++k, ++points) {
      const dvec3 p = somewhere(2.5), d = somewhere(1);
      int between = 0, inside = 0;
      for (uint32_t t = 0; t < own.indices.size(); t += 3) {
        const dvec3 to = light.position - p;
        const dvec3 a = corner(t), b = corner(t + 1), c = corner(t + 2), n = glm::cross(b - a, c - a);
        const double at = glm::dot(n, a - p) / glm::dot(n, to);
        between += at < 1 && crossing(p, to, a, b, c) != 0;
      }
      for (size_t i = 0; i < volumes.indices.size(); i += 3)
        inside +=
            crossing(p, d, end(volumes.indices[i]), end(volumes.indices[i + 1]), end(volumes.indices[i + 2]));
      ASSERT_EQ(inside, between) << "trial " << trial << " point " << k;
      hidden += between > 0;
    }
  }
  EXPECT_GT(hidden, points / 10);
  EXPECT_LT(hidden, points * 9 / 10);
}

}  // namespace
}  // namespace lightgrid
