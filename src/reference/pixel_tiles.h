// Pixels in square groups, so that lights far from a whole group are passed over at once.
#pragma once

#include <functional>
#include <vector>

#include "scene/view_lights.h"

namespace lightgrid {

// Positions in `pixels` (y * width + x each) grouped by tile of side x side pixels; tiles without one are left
// out.
std::vector<std::vector<uint32_t>> group_by_tile(int width, const std::vector<uint32_t>& pixels, uint32_t side = 16);

// Ascending indices of the lights that have some point of the positions' bounding box nearer than their
// radius. A light left out has no position nearer than its radius as length_of computes it: the distance to
// the box is made by the same operations from smaller operands, and rounding is monotone.
std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<glm::dvec3>& positions);

// Of those `among` alone.
std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights, const std::vector<uint32_t>& among,
                                          const std::vector<glm::dvec3>& positions);

// A tile of 16 x 16 pixels, or what `pixels` has of it.
struct TileOfPixels {
  std::vector<uint32_t> places;         // in `pixels`
  std::vector<glm::dvec3> positions;    // of these
  std::vector<uint32_t> lights;         // lights_within_reach of the positions
};

// Calls body for each tile that has pixels, on all cores and in no stated order. Lights are looked for in regions of
// 8 x 8 tiles first: a million lights are then gone through some sixty times an image, not some thousand times.
void for_each_tile(int width, const std::vector<uint32_t>& pixels, const std::function<glm::dvec3(uint32_t pixel)>& position_of,
                   const std::vector<ViewLight>& lights, const std::function<void(const TileOfPixels&)>& body);

}  // namespace lightgrid
