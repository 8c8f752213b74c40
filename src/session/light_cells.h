// Cells of engines, laid out as each engine does, and the lights that it lists in each (LimitCells).
#pragma once

#include <vector>

#include "scene/view_lights.h"
#include "session/engine_limits.h"

namespace lightgrid {

struct LightBox {
  glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
};

// Around what a light reaches: the ball of its range; of a spot, a cone that ends flat at its range. Infinite
// without a range.
LightBox box_of_light(const LightBounds& light);

bool meets(const LightBox& a, const LightBox& b);
bool meets(const LightBox& box, const glm::dvec3& center, double radius);

// Cells from the left, the bottom and the near plane.
struct LightCells {
  glm::ivec3 size{0};
  std::vector<std::vector<int>> lights;  // of each cell, x fastest; in the order of the lights given
  std::vector<LightBox> boxes;           // of each cell, in view space

  size_t entries() const;
  glm::ivec3 cell(size_t index) const {
    const int i = int(index);
    return {i % size.x, i / size.x % size.y, i / (size.x * size.y)};
  }
};

// `lights`: indices of `in_view`, the scene's lights, point or spot, with their ranges. layout: not none.
LightCells cells_of(LimitCells layout, const View& view, const std::vector<ViewLight>& in_view,
                    const std::vector<int>& lights);

}  // namespace lightgrid
