#include "oracle/triangle_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/glm.hpp>

namespace lightgrid::lab {

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
      box.min = glm::min(box.min, of.min);
      box.max = glm::max(box.max, of.max);
    }
    nodes_[at].box = box;
    if (count <= max_in_leaf) continue;
    const glm::dvec3 size = box.max - box.min;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const auto place = [&](int t) {
      const Corners& c = triangles[size_t(t)];
      return c[0][axis] + c[1][axis] + c[2][axis];
    };
    const auto begin = order_.begin() + first;
    std::nth_element(begin, begin + count / 2, begin + count,
                     [&](int a, int b) { return place(a) < place(b); });
    nodes_[at].first = int(nodes_.size());
    nodes_[at].count = 0;
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

// Rounding in double is far below `reach`, which is more than a rounding in float.
TriangleTree::Shaft::Shaft(const glm::dvec3& from, const WorldBox& to, double reach)
    : around_{glm::min(from, to.min) - reach, glm::max(from, to.max) + reach} {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    for (int corner = 0; corner < 4; ++corner) {
      const double x = (corner & 1 ? to.max : to.min)[i] - from[i],
                   y = (corner & 2 ? to.max : to.min)[j] - from[j], length = std::hypot(x, y);
      if (!(length > reach)) continue;
      for (const double turn : {1.0, -1.0}) {
        const Plane p{i, j, -y / length * turn, x / length * turn, 0};
        const double farthest = std::max(p.x * (to.min[i] - from[i]), p.x * (to.max[i] - from[i])) +
                                std::max(p.y * (to.min[j] - from[j]), p.y * (to.max[j] - from[j]));
        if (farthest > 1e-12 * length || count_ == int(planes_.size())) continue;
        planes_[size_t(count_)] = p;
        planes_[size_t(count_++)].d = p.x * from[i] + p.y * from[j] + reach * (std::abs(p.x) + std::abs(p.y));
      }
    }
  }
}

bool TriangleTree::Shaft::meets(const WorldBox& box) const {
  for (int k = 0; k < 3; ++k) {
    if (box.min[k] > around_.max[k] || box.max[k] < around_.min[k]) return false;
  }
  for (int k = 0; k < count_; ++k) {
    const Plane& p = planes_[size_t(k)];
    const double nearest =
        std::min(p.x * box.min[p.i], p.x * box.max[p.i]) + std::min(p.y * box.min[p.j], p.y * box.max[p.j]);
    if (nearest > p.d) return false;
  }
  return true;
}

}  // namespace lightgrid::lab
