// Comparisons of vectors in double.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>

namespace lightgrid::lab {

inline void expect_near(const glm::dvec3& got, const glm::dvec3& want, double tolerance) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(got[i], want[i], tolerance) << "channel " << i;
}

inline bool finite_and_not_negative(const glm::dvec3& c) {
  for (int i = 0; i < 3; ++i) {
    if (!(std::isfinite(c[i]) && c[i] >= 0)) return false;
  }
  return true;
}

}  // namespace lightgrid::lab
