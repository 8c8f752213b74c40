// The rasteriser's pixels against the coverage oracle, one by one.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "raster/random_triangles.h"

namespace lightgrid {
namespace {

constexpr int sizes[][2] = {{1, 1}, {17, 9}, {64, 64}, {65, 63}, {200, 130}};

class RasterCoverage : public testing::TestWithParam<RasterOptions> {
 protected:
  RasterOptions options() const { return GetParam(); }
};

TEST_P(RasterCoverage, RandomTrianglesOfEachKind) {
  size_t covered = 0;
  for (int kind = 0; kind < 6; ++kind) {
    for (const auto& [width, height] : sizes) {
      SCOPED_TRACE(fmt::format("kind {}, {} x {}", kind, width, height));
      RandomNumbers random(uint32_t(100 * kind + width));
      for (const bool two_sided : {false, true}) {
        TriangleScene scene = scene_of(plain_view(width, height));
        scene.instances[0].two_sided = two_sided;
        for (int i = 0; i < 150; ++i) add_random_triangle(random, kind, scene);
        const Drawn result = drawn(scene, options());
        ASSERT_EQ(count_wrong(result, oracle_of(result, scene)), 0);
        covered += result.covered();
      }
    }
  }
  EXPECT_GT(covered, 50000u) << "little was drawn";
}

TEST_P(RasterCoverage, OneTriangleAtATimeHasExactlyItsPixels) {
  RandomNumbers random(7);
  for (int i = 0; i < 200; ++i) {
    TriangleScene scene = scene_of(i % 2 ? plain_view(70, 66) : plain_view(33, 130));
    scene.instances[0].two_sided = true;
    add_random_triangle(random, i % 6, scene);
    SCOPED_TRACE(i);
    const Drawn result = drawn(scene, options());
    ASSERT_EQ(count_wrong(result, oracle_of(result, scene)), 0);
  }
}

TEST_P(RasterCoverage, LargerView) {
  RandomNumbers random(3);
  TriangleScene scene = scene_of(plain_view(1279, 721));
  for (int i = 0; i < 60; ++i) add_random_triangle(random, i % 6, scene);
  expect_right(scene, options());
}

TEST_P(RasterCoverage, OrthographicViewsWithANearAndAFarPlane) {
  RandomNumbers random(5);
  TriangleScene scene = scene_of(flat_view(100, 75));
  scene.instances[0].two_sided = true;
  for (int i = 0; i < 200; ++i) {
    const auto corner = [&] {
      return glm::vec3(random.between(-1.5, 1.5), random.between(-1.5, 1.5), random.between(-1.5, 0.5));
    };
    const glm::vec3 a = corner(), b = corner(), c = corner();
    add_triangle(scene.meshes[0], a, b, c);
  }
  expect_right(scene, options());
}

// Corners up to 3e38 depth ranges behind the far plane: what of their triangles is before it is at most an
// edge.
TEST_P(RasterCoverage, CornersFarBehindTheFarPlane) {
  RasterCamera steep = plain_view(90, 70, 1e30);  // its far plane is at 1 m, its near plane 1e-30 m before
  steep.clip_from_view[2][2] = 1e30;
  RandomNumbers random(6);
  size_t covered = 0;
  for (const RasterCamera& view : {flat_view(100, 75), flat_view(33, 130), steep}) {
    const bool flat = view.clip_from_view[2][3] == 0;
    for (const double deepest : {1e5, 1e16, 1e20, 1e25, 1e32, 3e38}) {
      SCOPED_TRACE(fmt::format("{} x {}, {:g}", view.grid.width, view.grid.height, deepest));
      TriangleScene scene = scene_of(view);
      scene.instances[0].two_sided = true;
      for (int i = 0; i < 150; ++i) {
        // One in three is in view whole, the others have one corner or two behind it.
        const int deep = random.below(3);
        glm::vec3 corners[3];
        for (int k = 0; k < 3; ++k) {
          const double depth =
              k < deep ? std::exp(random.between(0, std::log(deepest))) : random.between(0, 1);
          const double reach = i % 4 == 0 ? 100 : 1.5;
          const double x = random.between(-reach, reach), y = random.between(-reach, reach);
          const double distance = k < deep ? 1 + depth : 1 - 0.5 * depth;
          corners[(k + i) % 3] = flat ? glm::vec3(x, y, -depth) : glm::vec3(x, y, -1) * float(distance);
        }
        add_triangle(scene.meshes[0], corners[0], corners[1], corners[2]);
      }
      const Drawn result = drawn(scene, options());
      ASSERT_EQ(count_wrong(result, oracle_of(result, scene)), 0);
      if (flat) {
        EXPECT_EQ(result.counts.invalid_triangles, 0u);
      }
      covered += result.covered();
    }
  }
  EXPECT_GT(covered, 50000u);
}

TEST_P(RasterCoverage, TurnedMovedScaledAndMirroredInstances) {
  RandomNumbers random(11);
  TriangleScene scene;
  scene.camera = plain_view(160, 90);
  scene.camera.eye = {1e5, -3, 7};
  for (int m = 0; m < 3; ++m) {
    scene.meshes.emplace_back();
    for (int i = 0; i < 20 + 33 * m; ++i) {
      const auto corner = [&] {
        return glm::vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
      };
      const glm::vec3 a = corner(), b = corner(), c = corner();
      add_triangle(scene.meshes.back(), a, b, c);
    }
  }
  for (int i = 0; i < 12; ++i) {
    glm::dmat4 m(1);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) m[c][r] = random.between(-1, 1);
    }
    m[3] = {1e5 + random.between(-4, 4), -3 + random.between(-3, 3), 7 - random.between(1, 8), 1};
    scene.instances.push_back({.mesh = i % 3, .world_from_object = m, .two_sided = i % 4 == 3});
  }
  const Drawn result = drawn(scene, options());
  EXPECT_EQ(count_wrong(result, oracle_of(result, scene)), 0);
  EXPECT_GT(result.covered(), 5000u);
}

// A mesh of triangles over the whole image and beyond, its inner vertices anywhere near their place.
TriangleScene sheet(const RasterCamera& view, int cells, uint32_t seed, bool on_centres) {
  RandomNumbers random(seed);
  TriangleScene scene = scene_of(view);
  TriangleScene::MeshData& mesh = scene.meshes[0];
  for (int y = 0; y <= cells; ++y) {
    for (int x = 0; x <= cells; ++x) {
      // A little more than the image; vertices move by less than a quarter of a cell, so that no triangle
      // turns over.
      double px = (double(x) / cells * 1.4 - 0.2 + random.between(-0.3, 0.3) / cells) * view.grid.width;
      double py = (double(y) / cells * 1.4 - 0.2 + random.between(-0.3, 0.3) / cells) * view.grid.height;
      if (on_centres) {
        px = std::floor(px) + 0.5;
        py = std::floor(py) + 0.5;
      }
      mesh.positions.push_back(at(view, px, py, on_centres ? 1.0 : random.between(1, 1.1)));
    }
  }
  for (int y = 0; y < cells; ++y) {
    for (int x = 0; x < cells; ++x) {
      const uint32_t a = uint32_t(y * (cells + 1) + x), b = a + 1, c = a + uint32_t(cells) + 1, d = c + 1;
      for (const uint32_t i : {a, b, d, a, d, c}) mesh.indices.push_back(i);
    }
  }
  return scene;
}

// Every triangle of `scene` in one of `count` scenes of its own.
std::vector<TriangleScene> dealt_out(const TriangleScene& scene, size_t count) {
  std::vector<TriangleScene> parts(count, scene);
  for (size_t part = 0; part < count; ++part) {
    std::vector<uint32_t>& indices = parts[part].meshes[0].indices;
    indices.clear();
    const std::vector<uint32_t>& all = scene.meshes[0].indices;
    for (size_t i = 3 * part; i < all.size(); i += 3 * count)
      indices.insert(indices.end(), &all[i], &all[i] + 3);
  }
  return parts;
}

TEST_P(RasterCoverage, TrianglesThatShareEdgesLeaveNoPixelOutAndClaimNoneTwice) {
  for (const bool on_centres : {false, true}) {
    const TriangleScene scene = sheet(plain_view(150, 140), 23, 5, on_centres);
    const Drawn whole = drawn(scene, options());
    EXPECT_EQ(whole.covered(), whole.triangles.size());
    EXPECT_EQ(count_wrong(whole, oracle_of(whole, scene)), 0);
    // Two triangles that share an edge or a corner are never in one of 11 parts, so that claims add up.
    size_t claims = 0;
    for (const TriangleScene& part : dealt_out(scene, 11)) claims += drawn(part, options()).covered();
    EXPECT_EQ(claims, whole.triangles.size());
  }
}

// A floor of planks that begin in front of the eye and end far behind it: the near plane cuts each in the
// lower half of the image. One step of a float at the far end is half a pixel there.
TEST_P(RasterCoverage, CutTrianglesMeetTheirNeighbours) {
  RandomNumbers random(2);
  TriangleScene scene = scene_of(plain_view(223, 240, 0.01));
  TriangleScene::MeshData& mesh = scene.meshes[0];
  constexpr int planks = 2000;
  for (int i = 0; i <= planks; ++i) {
    const double across = 0.0004 * (i - planks / 2 + random.between(-0.2, 0.2));
    for (const double along : {-random.between(0.15, 0.2), random.between(700, 800)}) {
      mesh.positions.push_back(glm::vec3(across + 0.375 * along, -0.005, along));
    }
    if (i == 0) continue;
    const uint32_t front = uint32_t(2 * i - 2);
    for (const uint32_t k : {0, 1, 2, 2, 1, 3}) mesh.indices.push_back(front + k);
  }
  const Drawn whole = drawn(scene, options());
  EXPECT_EQ(count_wrong(whole, oracle_of(whole, scene)), 0);
  std::vector<int> claims(whole.triangles.size(), 0);
  for (const TriangleScene& part : dealt_out(scene, 11)) {
    const Drawn some = drawn(part, options());
    for (size_t i = 0; i < claims.size(); ++i) claims[i] += some.triangles[i] != no_triangle;
  }
  // The near plane is met at row 60; the planks begin at row 115.
  for (int y = 0; y < 112; ++y) {
    for (int x = 0; x < whole.grid.width; ++x) {
      const size_t i = whole.grid.index(x, y);
      ASSERT_EQ(claims[i], whole.triangles[i] != no_triangle) << x << " " << y;
      if (y < 58 || y > 62) {
        ASSERT_EQ(whole.triangles[i] != no_triangle, y > 60) << x << " " << y;
      }
    }
  }
}

TEST_P(RasterCoverage, AFanOfAThousandSliversAroundAPixelsCentre) {
  TriangleScene scene = scene_of(plain_view(131, 127));
  TriangleScene::MeshData& mesh = scene.meshes[0];
  constexpr int count = 1000;
  mesh.positions.push_back(at(scene.camera, 65.5, 60.5, 2));
  for (int i = 0; i < count; ++i) {
    const double angle = i * 6.283185307179586 / count;
    mesh.positions.push_back(at(scene.camera, 65.5 + 300 * std::cos(angle), 60.5 + 300 * std::sin(angle), 3));
    for (const int k : {0, 1 + i, 1 + (i + 1) % count}) mesh.indices.push_back(uint32_t(k));
  }
  const Drawn whole = drawn(scene, options());
  EXPECT_EQ(whole.covered(), whole.triangles.size());
  const CoverageOracle oracle = oracle_of(whole, scene);
  EXPECT_EQ(count_wrong(whole, oracle), 0);
  for (int y = 0; y < whole.grid.height; ++y) {
    for (int x = 0; x < whole.grid.width; ++x) ASSERT_EQ(oracle.at(x, y).size(), 1u) << x << " " << y;
  }
}

TEST_P(RasterCoverage, CornersThatAreNoNumbersOrFarTooLarge) {
  constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN(),
                  most = std::numeric_limits<float>::max();
  TriangleScene scene = scene_of(plain_view(50, 40));
  scene.instances[0].two_sided = true;
  for (const float strange : {inf, -inf, nan, most, -most, 1e30f, -1e30f, 1e-40f, 0.0f}) {
    for (int part = 0; part < 3; ++part) {
      for (int corner = 0; corner < 3; ++corner) {
        glm::vec3 corners[3] = {at(scene.camera, 5, 4, 3), at(scene.camera, 45, 8, 4),
                                at(scene.camera, 20, 35, 5)};
        corners[corner][part] = strange;
        add_triangle(scene.meshes[0], corners[0], corners[1], corners[2]);
      }
    }
  }
  const Drawn result = drawn(scene, options());
  const CoverageOracle oracle = oracle_of(result, scene);
  EXPECT_EQ(count_wrong(result, oracle), 0);
  EXPECT_EQ(result.counts.invalid_triangles, oracle.invalid_triangles());
  EXPECT_GE(result.counts.invalid_triangles, 27u);
}

TEST_P(RasterCoverage, TrianglesThroughTheEye) {
  RandomNumbers random(9);
  TriangleScene scene = scene_of(plain_view(90, 70));
  scene.instances[0].two_sided = true;
  for (int i = 0; i < 200; ++i) {
    const auto corner = [&] {
      return glm::vec3(random.below(3) - 1, random.below(3) - 1, random.below(3) - 1);
    };
    const glm::vec3 a = corner(), b = corner(), c = corner();
    add_triangle(scene.meshes[0], a, b, c);
  }
  expect_right(scene, options());
}

std::string shape_name(const testing::TestParamInfo<RasterOptions>& info) {
  if (info.param.shape == KernelShape::lanes) return info.param.portable ? "PortableLanes" : "Lanes";
  return info.param.wide_atomics ? "Group" : "GroupIn32Bits";
}

INSTANTIATE_TEST_SUITE_P(Shapes, RasterCoverage,
                         testing::Values(RasterOptions{.shape = KernelShape::lanes},
                                         RasterOptions{.shape = KernelShape::lanes, .portable = true},
                                         RasterOptions{.shape = KernelShape::group},
                                         RasterOptions{.shape = KernelShape::group, .wide_atomics = false}),
                         shape_name);

}  // namespace
}  // namespace lightgrid
