// The triangle that OpenGL shows at each pixel: not part of any technique's frame.
#pragma once

#include <array>
#include <compare>
#include <vector>

#include "passes/common/frame.h"

namespace lightgrid {

// A triangle by what it connects, so that two drawings of a mesh in different orders can be compared.
struct SceneTriangle {
  int instance = -1;                   // of the scene; -1: nothing
  std::array<uint32_t, 3> vertices{};  // of its mesh, turned so that the least is first
  auto operator<=>(const SceneTriangle&) const = default;
};

// From three entries of a mesh's indices.
SceneTriangle scene_triangle(int instance, const uint32_t* vertices);

struct ShownTriangles {
  std::vector<SceneTriangle> opaque;  // a pixel each, row 0 at the bottom
  std::vector<bool> blended;          // whether a blended surface lies over it
};

// Draws and reads them. Uses the depth image of the last frame.
ShownTriangles read_triangles(RenderView& v);

}  // namespace lightgrid
