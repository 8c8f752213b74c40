// Cells of engines, laid out as each engine does, and the lights that it lists in each (LimitCells).
#pragma once

#include <functional>
#include <vector>

#include "check/engine_limits.h"
#include "scene/view_lights.h"

namespace lightgrid::lab {

struct LightBox {
  glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
};

// Around what a light reaches: the ball of its range; of a spot, a cone that ends flat at its range. Infinite
// without a range.
LightBox box_of_light(const LightBounds& light);

bool meets(const LightBox& a, const LightBox& b);
bool meets(const LightBox& box, const glm::dvec3& center, double radius);

// The light with the ball that the engine tests against cells: in three.js, a spot has the smallest around its cone.
ViewLight as_listed(LimitCells layout, ViewLight light);

// A cell, from the left, the bottom and the near plane; its box in view space; its lights, in the order of
// those given.
using CellVisit =
    std::function<void(const glm::ivec3& cell, const LightBox& box, const std::vector<int>& lights)>;

// Visits each cell, and returns how many there are in x, y and slices. `lights`: indices of `scene_lights`,
// point or spot, with their ranges. layout: not none.
glm::ivec3 each_cell(LimitCells layout, const View& view, const std::vector<ViewLight>& scene_lights,
                     const std::vector<int>& lights, const CellVisit& visit);

}  // namespace lightgrid::lab
