#include "base/facing.h"

#include <gtest/gtest.h>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace lightgrid {
namespace {

glm::dmat3 scaled(double x, double y, double z) {
  return glm::dmat3(glm::scale(glm::dmat4(1), glm::dvec3(x, y, z)));
}

glm::dmat3 turned(double angle) {
  return glm::dmat3(glm::rotate(glm::dmat4(1), angle, glm::dvec3(1, 2, -3)));
}

// To within rounding. Shaders square the length of the matrix in float.
void expect_normal(const glm::dmat3& m, const glm::dvec3& normal, const glm::dvec3& expected) {
  const glm::dvec3 n = normal_matrix(m, is_mirroring(m)) * normal;
  const glm::dmat3 all = normal_matrix(m, is_mirroring(m));
  const double size = glm::length(all[0]) + glm::length(all[1]) + glm::length(all[2]);
  EXPECT_TRUE(size > 1e-12 && size < 1e13) << size;
  EXPECT_GT(glm::dot(glm::normalize(n), expected), 1 - 1e-9) << n.x << " " << n.y << " " << n.z;
}

TEST(Facing, MapsOntoAPlaneKeepThePlanesNormalWhateverTheRounding) {
  for (int i = 0; i < 200; ++i) {
    const glm::dmat3 m = turned(0.1 * i) * scaled(2, 3, 0);
    EXPECT_TRUE(is_singular(m)) << i;
    EXPECT_FALSE(is_mirroring(m)) << i;
    expect_normal(m, {0, 0, 1}, turned(0.1 * i) * glm::dvec3(0, 0, 1));
    expect_normal(turned(0.1 * i) * scaled(-2, 3, 0), {0, 0, 1}, turned(0.1 * i) * glm::dvec3(0, 0, -1));
  }
}

TEST(Facing, MapsThatMirrorAreToldFromFlatOnesAtEveryScale) {
  for (const double size : {1e-30, 1e-9, 1.0, 1e9, 1e30}) {
    for (const double flat : {1.0, 1e-6, 1e-20}) {
      const glm::dmat3 m = scaled(size, -size * flat, size);
      EXPECT_TRUE(is_mirroring(m)) << size << " " << flat;
      EXPECT_FALSE(is_mirroring(-m)) << size << " " << flat;
      expect_normal(m, {0, 1, 0}, {0, -1, 0});
      expect_normal(m, {1, 0, 0}, {1, 0, 0});
    }
  }
}

TEST(Facing, MapsOntoALineOrAPointHaveNoNormals) {
  for (const glm::dmat3& m : {scaled(2, 0, 0), scaled(0, 0, 0)}) {
    EXPECT_TRUE(is_singular(m));
    EXPECT_EQ(normal_matrix(m, false), glm::dmat3(0));
  }
}

}  // namespace
}  // namespace lightgrid
