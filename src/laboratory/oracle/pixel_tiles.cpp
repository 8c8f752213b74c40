#include "oracle/pixel_tiles.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "base/parallel.h"
#include "oracle/attenuation.h"

namespace lightgrid::lab {

std::vector<std::vector<uint32_t>> group_by_tile(int width, const std::vector<uint32_t>& pixels,
                                                 uint32_t side) {
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

namespace {

struct Box {
  explicit Box(const std::vector<glm::dvec3>& positions) {
    for (const glm::dvec3& p : positions) {
      low = glm::min(low, p);
      high = glm::max(high, p);
    }
  }

  bool is_within_reach_of(const ViewLight& light) const {
    const glm::dvec3& c = light.position;
    const double x = std::max({low.x - c.x, c.x - high.x, 0.0});
    const double y = std::max({low.y - c.y, c.y - high.y, 0.0});
    const double z = std::max({low.z - c.z, c.z - high.z, 0.0});
    return is_directional(light) || length_of(x, y, z) < light.radius_m;
  }

  glm::dvec3 low{std::numeric_limits<double>::infinity()}, high = -low;
};

}  // namespace

std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<glm::dvec3>& positions) {
  const Box box(positions);
  std::vector<uint32_t> near;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (box.is_within_reach_of(lights[i])) near.push_back(i);
  }
  return near;
}

std::vector<uint32_t> lights_within_reach(const std::vector<ViewLight>& lights,
                                          const std::vector<uint32_t>& among,
                                          const std::vector<glm::dvec3>& positions) {
  const Box box(positions);
  std::vector<uint32_t> near;
  std::copy_if(among.begin(), among.end(), std::back_inserter(near),
               [&](uint32_t i) { return box.is_within_reach_of(lights[i]); });
  return near;
}

void for_each_tile(int width, const std::vector<uint32_t>& pixels,
                   const std::function<glm::dvec3(uint32_t pixel)>& position_of,
                   const std::vector<ViewLight>& lights,
                   const std::function<void(const TileOfPixels&)>& body) {
  const auto regions = group_by_tile(width, pixels, 128);
  parallel_for(int(regions.size()), [&](int r) {
    const std::vector<uint32_t>& of_region = regions[size_t(r)];
    std::vector<uint32_t> pixels_here;
    std::vector<glm::dvec3> positions;
    for (const uint32_t place : of_region) {
      pixels_here.push_back(pixels[place]);
      positions.push_back(position_of(pixels[place]));
    }
    const std::vector<uint32_t> near = lights_within_reach(lights, positions);
    for (const std::vector<uint32_t>& of_tile : group_by_tile(width, pixels_here)) {
      TileOfPixels tile;
      for (const uint32_t i : of_tile) {
        tile.indices.push_back(of_region[i]);
        tile.positions.push_back(positions[i]);
      }
      tile.lights = lights_within_reach(lights, near, tile.positions);
      body(tile);
    }
  });
}

}  // namespace lightgrid::lab
