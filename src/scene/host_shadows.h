// The shadows that a frame shaded with, for the oracle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// Lists of lights in tiles of 16 x 16 pixels, and eight words of `bits` an entry. A bit is set where the
// light, or more than half of it, is hidden at that pixel: bit (y % 4) * 4 + x % 4 of block (y / 4) * 4 + x / 4, x and y from the
// tile's lower left pixel; block b is the low half of word b / 2 for even b, else the high one.
struct HostShadows {
  static constexpr int side = 16, words = 8;
  int tiles_x = 0, tiles_y = 0;
  std::vector<glm::uvec2> cells;  // first entry and number of entries, a tile; x fastest from the lower left
  std::vector<uint32_t> indices;  // of point and spot lights in scene order; ascending in each cell
  std::vector<uint32_t> bits;     // `words` an entry of indices
};

// Whether a light loop is told that the light is hidden at a pixel, row 0 at the bottom. A light that the
// tile does not list is not hidden.
inline bool hidden_at(const HostShadows& shadows, int x, int y, uint32_t light) {
  constexpr int side = HostShadows::side;
  const glm::uvec2 cell = shadows.cells[size_t(y / side) * size_t(shadows.tiles_x) + size_t(x / side)];
  const auto begin = shadows.indices.begin() + cell.x, end = begin + cell.y;
  const auto found = std::lower_bound(begin, end, light);
  if (found == end || *found != light) return false;
  const size_t entry = size_t(found - shadows.indices.begin());
  const int block = y % side / 4 * 4 + x % side / 4, bit = block % 2 * 16 + y % 4 * 4 + x % 4;
  return shadows.bits[entry * HostShadows::words + size_t(block / 2)] >> bit & 1;
}

}  // namespace lightgrid
