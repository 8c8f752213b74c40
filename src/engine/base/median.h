// Medians, which a minority of values cannot move however large it is.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lightgrid {

// Returns the upper one of an even number of values, and 0 without values.
inline double median_of(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// The median of each coordinate: each is one of a point.
inline glm::dvec3 median_of(std::span<const glm::dvec3> points) {
  glm::dvec3 middle;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::ranges::transform(points, values.begin(), [&](const glm::dvec3& p) { return p[axis]; });
    middle[axis] = median_of(values);
  }
  return middle;
}

}  // namespace lightgrid
