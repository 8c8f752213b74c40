// A tree of boxes around triangles, split at medians: finds those near a segment.
#pragma once

#include <array>
#include <vector>

#include "base/world_box.h"

namespace lightgrid::lab {

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
        stack[height++] = node.first + 1;
        stack[height++] = node.first;
        continue;
      }
      for (int i = 0; i < node.count; ++i) {
        const int triangle = order_[size_t(node.first + i)];
        if (meets(boxes_[size_t(triangle)], from, to, reach) && visit(triangle)) return;
      }
    }
  }

  // Calls visit(index) for triangles, among them all whose boxes, grown by `reach`, meet a segment from
  // `from` to any point of the box `to`.
  template <typename Visit>
  void walk_shaft(const glm::dvec3& from, const WorldBox& to, double reach, const Visit& visit) const {
    if (nodes_.empty()) return;
    const Shaft shaft(from, to, reach);
    int stack[depth_limit], height = 0;
    stack[height++] = 0;
    while (height > 0) {
      const Node& node = nodes_[size_t(stack[--height])];
      if (!shaft.meets(node.box)) continue;
      if (node.count == 0) {
        stack[height++] = node.first + 1;
        stack[height++] = node.first;
      }
      for (int i = 0; i < node.count; ++i) {
        const int triangle = order_[size_t(node.first + i)];
        if (shaft.meets(boxes_[size_t(triangle)])) visit(triangle);
      }
    }
  }

  // Returns whether the box of a triangle, grown by `reach`, meets the segment.
  bool is_near(int triangle, const glm::dvec3& from, const glm::dvec3& to, double reach) const {
    return meets(boxes_[size_t(triangle)], from, to, reach);
  }

 private:
  // All segments from a point to a box: a box around them, and planes along two axes' plane that pass the
  // point and touch the box (Haines, Wallace, "Shaft Culling for Efficient Ray-Traced Radiosity", 1991).
  class Shaft {
   public:
    Shaft(const glm::dvec3& from, const WorldBox& to, double reach);
    bool meets(const WorldBox& box) const;

   private:
    struct Plane {
      int i, j;        // axes
      double x, y, d;  // outside: x p[i] + y p[j] > d
    };
    WorldBox around_;
    std::array<Plane, 6> planes_;
    int count_ = 0;
  };

  static constexpr int depth_limit = 64, max_in_leaf = 4;
  struct Node {
    WorldBox box{};
    int first = 0, count = 0;  // range in order_; without triangles the first of two nodes
  };
  static bool meets(const WorldBox& box, const glm::dvec3& from, const glm::dvec3& to, double reach);

  std::vector<Node> nodes_;
  std::vector<int> order_;
  std::vector<WorldBox> boxes_;  // boxes of triangles
};

}  // namespace lightgrid::lab
