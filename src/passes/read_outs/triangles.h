// The triangle that OpenGL shows at each pixel: not part of any technique's frame.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <vector>

#include "passes/common/frame.h"

namespace lightgrid {

// A triangle by what it connects and which way it turns, so that two drawings of a mesh in different orders
// can be compared.
struct SceneTriangle {
  int instance = -1;  // of the scene; -1: nothing
  // Of its mesh, in the order of the mesh, which side faces front included; the least one first.
  std::array<uint32_t, 3> vertices{};
  auto operator<=>(const SceneTriangle&) const = default;
};

// corners: three indices of the mesh.
inline SceneTriangle scene_triangle(int instance, const uint32_t* corners) {
  SceneTriangle triangle{instance, {corners[0], corners[1], corners[2]}};
  std::ranges::rotate(triangle.vertices, std::ranges::min_element(triangle.vertices));
  return triangle;
}

struct ShownTriangles {
  std::vector<SceneTriangle> opaque;  // a pixel each, row 0 at the bottom
  std::vector<bool> blended;          // whether a blended surface lies over it
};

// Draws and reads them. Uses the depth image of the last frame.
ShownTriangles read_triangles(Work& work, const Seen& seen);

}  // namespace lightgrid
