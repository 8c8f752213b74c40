#include "raster/raster_arrays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lightgrid {
namespace {

constexpr int levels = 10;                // of the curve: cells a side are 2 to the power of this
constexpr size_t triangles_a_cell = 512;  // of the coarse cells: some clusters for each of six directions

glm::dvec3 corner_of(const RasterMesh& mesh, size_t triangle, int k) {
  return mesh.positions[mesh.indices[3 * triangle + k]];
}

// Place on the Z-order curve (Morton 1966) of a point in the unit cube.
uint64_t morton(const glm::dvec3& p) {
  uint64_t code = 0;
  for (int bit = levels - 1; bit >= 0; --bit) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto cell = uint32_t(std::clamp(p[axis], 0.0, 1.0) * ((1 << levels) - 1));
      code = code << 1 | (cell >> bit & 1);
    }
  }
  return code;
}

// Which side of a cube the triangle faces: 0 to 5.
uint64_t facing(const RasterMesh& mesh, size_t triangle) {
  const glm::dvec3 a = corner_of(mesh, triangle, 0);
  const glm::dvec3 normal = glm::cross(corner_of(mesh, triangle, 1) - a, corner_of(mesh, triangle, 2) - a);
  int axis = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal[k]) > std::abs(normal[axis])) axis = k;
  }
  return uint64_t(2 * axis + (normal[axis] < 0));
}

// Levels that coarse cells have: a surface meets about 4 to the power of that many.
int coarse_levels(size_t triangles) {
  int n = 0;
  while (n < levels && triangles > triangles_a_cell << 2 * n) ++n;
  return n;
}

}  // namespace

std::vector<uint32_t> cluster_order(const RasterMesh& mesh) {
  const size_t count = mesh.indices.size() / 3;
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
  for (const uint32_t i : mesh.indices) {
    const glm::dvec3 p = mesh.positions[i];
    if (!std::isfinite(p.x + p.y + p.z)) continue;
    low = glm::min(low, p), high = glm::max(high, p);
  }
  const double extent = std::max({high.x - low.x, high.y - low.y, high.z - low.z, 1e-300});
  const int fine_bits = 3 * (levels - coarse_levels(count));
  std::vector<uint64_t> keys(count);
  for (size_t t = 0; t < count; ++t) {
    const glm::dvec3 center = (corner_of(mesh, t, 0) + corner_of(mesh, t, 1) + corner_of(mesh, t, 2)) / 3.0;
    const bool finite = std::isfinite(center.x + center.y + center.z);
    const uint64_t code = finite ? morton((center - low) / extent) : 0;
    const uint64_t fine = code & ((uint64_t(1) << fine_bits) - 1);
    keys[t] = (code >> fine_bits) << (fine_bits + 3) | (finite ? facing(mesh, t) : 7) << fine_bits | fine;
  }
  std::vector<uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return keys[a] < keys[b]; });
  return order;
}

}  // namespace lightgrid
