#include "reference/pixel_tiles.h"

#include <algorithm>

#include "reference/attenuation.h"

namespace lightgrid {

std::vector<std::vector<uint32_t>> group_by_tile(int width, const std::vector<uint32_t>& pixels) {
  constexpr uint32_t side = 16;
  const uint32_t across = (width + side - 1) / side;
  std::vector<std::vector<uint32_t>> tiles;
  for (uint32_t i = 0; i < pixels.size(); ++i) {
    const uint32_t x = pixels[i] % width, y = pixels[i] / width;
    const size_t tile = size_t(y / side) * across + x / side;
    if (tile >= tiles.size()) tiles.resize(tile + 1);
    tiles[tile].push_back(i);
  }
  std::erase_if(tiles, [](const auto& tile) { return tile.empty(); });
  return tiles;
}

std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<glm::dvec3>& positions) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const glm::dvec3& p : positions) low = glm::min(low, p), high = glm::max(high, p);
  std::vector<uint32_t> near;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    const glm::dvec3& c = lights[i].position;
    const double x = std::max({low.x - c.x, c.x - high.x, 0.0});
    const double y = std::max({low.y - c.y, c.y - high.y, 0.0});
    const double z = std::max({low.z - c.z, c.z - high.z, 0.0});
    if (lights[i].type == LightType::directional || length_of(x, y, z) < lights[i].radius_m)
      near.push_back(i);
  }
  return near;
}

}  // namespace lightgrid
