// Pixels in square tiles, so that lights far from a whole tile are skipped at once.
#pragma once

#include <functional>
#include <vector>

#include "scene/view_lights.h"

namespace lightgrid::lab {

// Indices into `pixels` (y * width + x each), grouped by tile of side x side pixels; tiles without pixels are
// omitted.
std::vector<std::vector<uint32_t>> group_by_tile(int width, const std::vector<uint32_t>& pixels,
                                                 uint32_t side = 16);

// Ascending indices of the lights whose radius exceeds their distance to the bounding box of the positions.
// An omitted light has no position nearer than its radius as length_of computes it: the distance to the box
// results from the same operations on smaller operands, and rounding is monotone.
std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<glm::dvec3>& positions);

// The same, restricted to the lights of `among`.
std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<uint32_t>& among,
                                          const std::vector<glm::dvec3>& positions);

// The pixels of a 16 x 16 tile that are in `pixels`.
struct TileOfPixels {
  std::vector<uint32_t> indices;      // in `pixels`
  std::vector<glm::dvec3> positions;  // positions of these
  std::vector<uint32_t> lights;       // lights_within_reach of the positions
};

// Calls body for each tile that has pixels, on all cores, in unspecified order. Lights are first selected for
// regions of 8 x 8 tiles: this reads a million lights about sixty times an image instead of thousands of
// times.
void for_each_tile(int width, const std::vector<uint32_t>& pixels,
                   const std::function<glm::dvec3(uint32_t pixel)>& position_of,
                   const std::vector<ViewLight>& lights,
                   const std::function<void(const TileOfPixels&)>& body);

}  // namespace lightgrid::lab
