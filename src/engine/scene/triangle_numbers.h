// A triangle's number in its mesh from its vertices, wherever a reordered mesh has it.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "scene/scene.h"

namespace lightgrid {

// Rotated so that the least one is first: which side faces front stays the same.
using TriangleVertices = std::array<uint32_t, 3>;

// corners: three indices of the mesh.
inline TriangleVertices triangle_vertices(const uint32_t* corners) {
  TriangleVertices vertices{corners[0], corners[1], corners[2]};
  std::ranges::rotate(vertices, std::ranges::min_element(vertices));
  return vertices;
}

class TriangleNumbers {
 public:
  explicit TriangleNumbers(const Mesh& mesh) {
    for (uint32_t t = 0; t < mesh.indices.size() / 3; ++t)
      sorted_.push_back({triangle_vertices(&mesh.indices[3 * size_t(t)]), t});
    std::ranges::sort(sorted_);
  }

  // The first of several that connect the same vertices.
  std::optional<uint32_t> find(const TriangleVertices& vertices) const {
    const auto at = std::ranges::lower_bound(sorted_, Numbered{vertices, 0});
    if (at == sorted_.end() || at->vertices != vertices) return {};
    return at->number;
  }

 private:
  struct Numbered {
    TriangleVertices vertices;
    uint32_t number;
    auto operator<=>(const Numbered&) const = default;
  };
  std::vector<Numbered> sorted_;
};

}  // namespace lightgrid
