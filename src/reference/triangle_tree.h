// A tree of boxes around triangles, split at medians: finds those near a segment.
#pragma once

#include <array>
#include <vector>

#include "base/world_box.h"

namespace lightgrid {

using Corners = std::array<glm::dvec3, 3>;

class TriangleTree {
 public:
  TriangleTree() = default;
  explicit TriangleTree(const std::vector<Corners>& triangles);

  // Calls visit(index) for each triangle whose box, grown by `reach` on all sides, meets the segment from
  // `from` to `to`, until it returns true. The order depends on nothing but the arguments.
  template <typename Visit>
  void walk(const glm::dvec3& from, const glm::dvec3& to, double reach, const Visit& visit) const {
    if (nodes_.empty()) return;
    int stack[depth_limit], height = 0;
    stack[height++] = 0;
    while (height > 0) {
      const Node& node = nodes_[size_t(stack[--height])];
      if (!meets(node.box, from, to, reach)) continue;
      if (node.count == 0) {
        stack[height++] = node.first + 1, stack[height++] = node.first;
        continue;
      }
      for (int i = 0; i < node.count; ++i) {
        const int triangle = order_[size_t(node.first + i)];
        if (meets(boxes_[size_t(triangle)], from, to, reach) && visit(triangle)) return;
      }
    }
  }

 private:
  static constexpr int depth_limit = 64, most_in_leaf = 4;
  struct Node {
    WorldBox box{};
    int first = 0, count = 0;  // of order_; without triangles the first of two nodes
  };
  static bool meets(const WorldBox& box, const glm::dvec3& from, const glm::dvec3& to, double reach);

  std::vector<Node> nodes_;
  std::vector<int> order_;
  std::vector<WorldBox> boxes_;  // of triangles
};

}  // namespace lightgrid
