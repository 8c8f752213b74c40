// Pictures held by hash: of each view a hash a tile of what each stage of a frame left behind, bit for bit.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/json_file.h"
#include "run/frames.h"

namespace lightgrid::lab {

// In the order of the frame: a stage reads the ones before it.
inline constexpr std::array golden_stages = {"triangles", "depth", "lists", "radiance"};

// The results of the stages at each pixel, row 0 at the bottom.
struct GoldenPixels {
  std::vector<uint32_t> triangles;  // a hash of the nearest opaque one: its instance and vertices
  std::vector<uint32_t> depth;      // the bits of a float
  std::vector<uint32_t> lists;      // a hash of the lights that it reads, in their order; 0 on background
  Image image;                      // radiance, without the tone map; alpha does not count

  bool same(size_t stage, const GoldenPixels& other, size_t pixel) const;
};

// Reads the run's last frame.
GoldenPixels golden_pixels(TechniqueRun& run);

// Hashes of a view, 16 hexadecimal digits a tile; rows of tiles from the bottom.
struct GoldenView {
  int width = 0, height = 0;
  int tile = 64;  // pixels a side
  std::array<std::vector<std::string>, golden_stages.size()> stages;

  int across() const { return (width + tile - 1) / tile; }
  int down() const { return (height + tile - 1) / tile; }
};

// The tile is 64 pixels, doubled until a view has 64 tiles or fewer.
GoldenView golden_view(const GoldenPixels& pixels);

struct GoldenDifference {
  size_t stage = 0;  // the first that differs
  int tile_x = 0, tile_y = 0;
  size_t tiles = 0;  // that differ in this stage
};

// None: the same. Throws Error(input) if the sizes differ.
std::optional<GoldenDifference> first_difference(const GoldenView& recorded, const GoldenView& drawn);

nlohmann::ordered_json to_json(const GoldenView& view);
// Throws Error(input) that names the field.
GoldenView golden_view(const JsonFields& fields);

}  // namespace lightgrid::lab
