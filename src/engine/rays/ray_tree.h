// A bounding volume hierarchy over boxes.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "shared/ray_records.h"

namespace lightgrid {

struct RayBox {
  glm::vec3 low{std::numeric_limits<float>::infinity()}, high{-std::numeric_limits<float>::infinity()};
  void add(const glm::vec3& p) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
};

struct RayTree {
  std::vector<RayNode> nodes;   // the root first, children after their parents
  std::vector<uint32_t> order;  // order of the boxes: leaves take runs of this
};

// Binned by the surface area heuristic (MacDonald, Booth, "Heuristics for ray tracing using space
// subdivision", The Visual Computer 1990; Wald, "On fast Construction of SAH-based Bounding Volume
// Hierarchies", RT 2007), on all cores. The same tree in every run. No path is longer than RAY_STACK. Boxes
// are finite.
RayTree ray_tree(const std::vector<RayBox>& boxes);

}  // namespace lightgrid
