// Clusters that the rasteriser skips: they face away or are out of view.
#include "raster/raster_view.h"

#include <gtest/gtest.h>

#include <cmath>

#include "raster/drawn.h"

namespace lightgrid {
namespace {

TriangleScene sphere(const RasterCamera& view, int rings, double radius, const glm::dvec3& center) {
  TriangleScene scene;
  scene.camera = view;
  scene.meshes.resize(1);
  TriangleScene::MeshData& mesh = scene.meshes[0];
  const int around = 2 * rings;
  for (int y = 0; y <= rings; ++y) {
    for (int x = 0; x < around; ++x) {
      const double up = 3.14159265358979 * y / rings, turn = 6.28318530717959 * x / around;
      mesh.positions.push_back(glm::vec3(radius * std::sin(up) * std::cos(turn), radius * std::cos(up),
                                         -radius * std::sin(up) * std::sin(turn)));
    }
  }
  for (int y = 0; y < rings; ++y) {
    for (int x = 0; x < around; ++x) {
      const uint32_t a = uint32_t(y * around + x), b = uint32_t(y * around + (x + 1) % around),
                     c = a + around, d = b + around;
      for (const uint32_t i : {a, c, b, b, c, d}) mesh.indices.push_back(i);
    }
  }
  scene.instances.push_back({.mesh = 0});
  scene.instances[0].world_from_object[3] = glm::dvec4(center, 1);
  return scene;
}

TEST(Rasterizer, ClustersThatFaceAwayAreLeftOutAndDoNotShow) {
  for (const double distance : {1.5, 4.0, 40.0}) {
    for (const bool mirrored : {false, true}) {
      TriangleScene scene = sphere(plain_view(300, 260, 0.01), 60, 1, {0.3, 0.1, -distance});
      if (mirrored) scene.instances[0].world_from_object[0][0] = -1;
      const Drawn with = drawn(scene), without = drawn(scene, {.cluster_cones = false});
      EXPECT_LT(with.counts.clusters, without.counts.clusters * 4 / 5);
      EXPECT_TRUE(with.same_image(without));
      EXPECT_EQ(count_wrong(with, oracle_of(with, scene)), 0);
      EXPECT_GT(with.covered(), distance > 10 ? 20u : 3000u);
    }
  }
  TriangleScene inside = sphere(plain_view(300, 260, 0.01), 60, 1, {0, 0, 0});
  EXPECT_EQ(drawn(inside).covered(), 0u);
  inside.instances[0].two_sided = true;
  const Drawn seen = drawn(inside);
  EXPECT_EQ(seen.covered(), seen.triangles.size()) << "a hole in a closed mesh";
  EXPECT_EQ(count_wrong(seen, oracle_of(seen, inside)), 0);
}

TEST(Rasterizer, ClustersOutOfViewAreLeftOut) {
  TriangleScene scene = sphere(plain_view(100, 100), 30, 1, {0, 0, 0});
  for (const glm::dvec3& place :
       {glm::dvec3{0, 0, 5}, {20, 0, -5}, {-20, 0, -5}, {0, 20, -5}, {0, -20, -5}}) {
    scene.instances[0].world_from_object[3] = glm::dvec4(place, 1);
    EXPECT_EQ(drawn(scene).counts.clusters, 0u);
  }
  scene.instances[0].world_from_object[3] = glm::dvec4(0, 0, -5, 1);
  EXPECT_GT(drawn(scene).counts.clusters, 10u);
}

}  // namespace
}  // namespace lightgrid
