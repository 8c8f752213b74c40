#include "base/facing.h"

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/matrix_inverse.hpp>

namespace lightgrid {
namespace {

constexpr double rounding = 0x1p-44;  // for determinants, relative to the sum of their terms' magnitudes

double sum_of_magnitudes(const glm::dmat3& m) {
  const glm::dvec3 a = glm::abs(m[0]), b = glm::abs(m[1]), c = glm::abs(m[2]);
  return a.x * (b.y * c.z + b.z * c.y) + a.y * (b.x * c.z + b.z * c.x) + a.z * (b.x * c.y + b.y * c.x);
}

double largest_element(const glm::dmat3& m) {
  double largest = 0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) largest = std::max(largest, std::abs(m[column][row]));
  }
  return largest;
}

// The determinant times the inverse transpose.
glm::dmat3 cofactors(const glm::dmat3& m) {
  return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

}  // namespace

bool is_singular(const glm::dmat3& m) {
  return !(std::abs(glm::determinant(m)) > rounding * sum_of_magnitudes(m));
}

bool is_mirroring(const glm::dmat3& m) { return glm::determinant(m) < 0 && !is_singular(m); }

glm::dmat3 normal_matrix(const glm::dmat3& m, bool mirrored) {
  if (!is_singular(m) && (glm::determinant(m) < 0) == mirrored) {
    const glm::dmat3 inverse = glm::inverseTranspose(m);
    const double largest = largest_element(inverse);
    // Shaders square lengths in float.
    if (largest > 1e-12 && largest < 1e12) return inverse;
  }
  const double size = largest_element(m);
  if (!(size > 0)) return glm::dmat3(0);
  const glm::dmat3 normals = cofactors(m * (1 / size));
  const double largest = largest_element(normals);
  return largest > 0 ? normals * ((mirrored ? -1 : 1) / largest) : glm::dmat3(0);
}

}  // namespace lightgrid
