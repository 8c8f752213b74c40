#include "reference/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/glm.hpp>

namespace lightgrid {

TriangleTree::TriangleTree(const std::vector<Corners>& triangles) : order_(triangles.size()) {
  if (triangles.empty()) return;
  std::iota(order_.begin(), order_.end(), 0);
  for (const auto& [a, b, c] : triangles)
    boxes_.push_back({glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)});
  nodes_.push_back({.first = 0, .count = int(triangles.size())});
  for (size_t at = 0; at < nodes_.size(); ++at) {
    const int first = nodes_[at].first, count = nodes_[at].count;
    WorldBox box{glm::dvec3(1e300), glm::dvec3(-1e300)};
    for (int i = first; i < first + count; ++i) {
      const WorldBox& of = boxes_[size_t(order_[size_t(i)])];
      box.min = glm::min(box.min, of.min), box.max = glm::max(box.max, of.max);
    }
    nodes_[at].box = box;
    if (count <= most_in_leaf) continue;
    const glm::dvec3 size = box.max - box.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](int t) {
      const Corners& c = triangles[size_t(t)];
      return c[0][axis] + c[1][axis] + c[2][axis];
    };
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](int a, int b) { return place(a) < place(b); });
    nodes_[at].first = int(nodes_.size()), nodes_[at].count = 0;
    nodes_.push_back({.first = first, .count = count / 2});
    nodes_.push_back({.first = first + count / 2, .count = count - count / 2});
  }
}

// Separating axes of a segment and a box: the box's own, and their cross products with the segment.
bool TriangleTree::meets(const WorldBox& box, const glm::dvec3& from, const glm::dvec3& to, double reach) {
  const glm::dvec3 half = (box.max - box.min) * 0.5 + reach, step = (to - from) * 0.5,
                   apart = (from + to) * 0.5 - (box.min + box.max) * 0.5, size = glm::abs(step);
  for (int k = 0; k < 3; ++k) {
    if (std::abs(apart[k]) > half[k] + size[k]) return false;
  }
  const glm::dvec3 across = glm::abs(glm::cross(step, apart));
  return across.x <= half.y * size.z + half.z * size.y && across.y <= half.x * size.z + half.z * size.x &&
         across.z <= half.x * size.y + half.y * size.x;
}

}  // namespace lightgrid
