// Points and matrices in double.
#pragma once

#include <gtest/gtest.h>

#include <glm/glm.hpp>

namespace lightgrid {

inline constexpr double root_half = 0.7071067811865476;

// Where the matrix moves a point to.
inline glm::dvec3 at(const glm::dmat4& m, const glm::dvec3& p) { return glm::dvec3(m * glm::dvec4(p, 1)); }

inline void expect_near(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12) {
  EXPECT_LE(glm::length(actual - expected), tolerance)
      << actual.x << " " << actual.y << " " << actual.z << " instead of " << expected.x << " " << expected.y
      << " " << expected.z;
}

}  // namespace lightgrid
