// The shadows that a frame shaded with, for the oracle.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// Lists of lights in tiles of 16 x 16 pixels, and of each entry a value for each pixel: value (y % 4) * 4 + x
// % 4 of block (y / 4) * 4 + x / 4, 16 a block, x and y from the tile's lower left pixel. Value v is bit v %
// 32 of word v / 32.
struct HostShadows {
  static constexpr int side = 16, words = 8;
  int tiles_x = 0, tiles_y = 0;
  std::vector<glm::uvec2> cells;  // first entry and number of entries, a tile; x fastest from the lower left
  // The lights of cells: point and spot lights in scene order, then directional ones; ascending in each cell.
  std::vector<uint32_t> indices;
  std::vector<uint32_t> bits;   // `words` an entry of indices: the light, or more than half of it, is hidden
  std::vector<uint8_t> shares;  // the hidden share times 255, in the same order; empty: bits say all
  bool local_alone = false;     // directional lights are stored elsewhere
  bool drops_hidden = false;    // a pixel's list lacks lights that are wholly hidden there
};

// The shadows of one layer of blended surfaces, and the fragments that it holds: of each pixel, row 0 at the
// bottom, depth (0: no fragment), the scene's instance (-1) and the triangle of its mesh.
struct HostShadowLayer {
  HostShadows shadows;
  std::vector<float> depth;
  std::vector<glm::ivec2> triangles;
};

// HostShadows::bits of shares.
inline std::vector<uint32_t> hidden_bits(const std::vector<uint8_t>& shares) {
  std::vector<uint32_t> bits(shares.size() / 32);
  for (size_t i = 0; i < shares.size(); ++i) {
    if (shares[i] > 127) bits[i / 32] |= 1u << (i % 32);
  }
  return bits;
}

// The value of a light at a pixel, row 0 at the bottom. None: the tile does not list it.
inline std::optional<size_t> shadow_value(const HostShadows& shadows, int x, int y, uint32_t light) {
  constexpr int side = HostShadows::side;
  const glm::uvec2 cell = shadows.cells[size_t(y / side) * size_t(shadows.tiles_x) + size_t(x / side)];
  const auto begin = shadows.indices.begin() + cell.x, end = begin + cell.y;
  const auto found = std::lower_bound(begin, end, light);
  if (found == end || *found != light) return {};
  const size_t entry = size_t(found - shadows.indices.begin());
  const int block = y % side / 4 * 4 + x % side / 4, value = block * 16 + y % 4 * 4 + x % 4;
  return entry * side * side + size_t(value);
}

// Returns whether a light loop reads that the light is hidden at a pixel. A light that the tile does not list
// is not.
inline bool hidden_at(const HostShadows& shadows, int x, int y, uint32_t light) {
  const auto value = shadow_value(shadows, x, y, light);
  return value && (shadows.bits[*value / 32] >> *value % 32 & 1);
}

// The share that it is told.
inline double hidden_share_at(const HostShadows& shadows, int x, int y, uint32_t light) {
  if (shadows.shares.empty()) return hidden_at(shadows, x, y, light);
  const auto value = shadow_value(shadows, x, y, light);
  return value ? shadows.shares[*value] / 255.0 : 0;
}

}  // namespace lightgrid
