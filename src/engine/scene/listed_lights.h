// The lights that a technique used at each pixel, for the oracle.
#pragma once

#include <cstdint>
#include <vector>

namespace lightgrid {

// Pixel p walks indices[first[c]] ... indices[first[c] + count[c] - 1], where
// c = cell_of_pixel[p]; an empty cell_of_pixel means that all pixels walk cell 0.
struct ListedLights {
  std::vector<uint32_t> cell_of_pixel;  // width * height, row 0 at the bottom
  std::vector<uint64_t> first;          // one a cell
  std::vector<uint32_t> count;          // one a cell
  std::vector<uint32_t> indices;        // point and spot lights in scene order (LightPlan::local)
};

// Places lists of these counts one after the other: sets `first`, and sizes `indices`. Throws Error(machine)
// if that takes more than half of the machine's memory.
void place_lists(ListedLights& lists);

// One cell of lights 0 ... count - 1 for all pixels: the lists of a technique without a grid.
ListedLights list_every_light(uint32_t count);

}  // namespace lightgrid
