// Pixels in square groups, so that lights far from a whole group are passed over at once.
#pragma once

#include <vector>

#include "scene/view_lights.h"

namespace lightgrid {

// Positions in `pixels` (y * width + x each) grouped by tile of 16 x 16 pixels; tiles without one are left
// out.
std::vector<std::vector<uint32_t>> group_by_tile(int width, const std::vector<uint32_t>& pixels);

// Ascending indices of the lights that have some point of the positions' bounding box nearer than their
// radius. A light left out has no position nearer than its radius as length_of computes it: the distance to
// the box is made by the same operations from smaller operands, and rounding is monotone.
std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<glm::dvec3>& positions);

}  // namespace lightgrid
