// The cells that shading finds, on the host and as shaders do: not part of any technique's frame.
#pragma once

#include <array>
#include <functional>
#include <span>

#include "passes/common/frame.h"
#include "scene/listed_lights.h"
#include "shared/slices.h"

namespace lightgrid {

inline constexpr uint32_t no_cell = 0xffffffffu;

// The unsigned integer that `draw` writes at each pixel, else no_cell. Uses the depth image of the last
// frame.
std::vector<uint32_t> indices_drawn(Work& work, const Seen& seen, const std::function<void()>& draw);

// The cell of each pixel that shows an opaque surface, else no_cell. Uses the depth image of the last frame.
std::vector<uint32_t> shaded_cells(Work& work, const Seen& seen);

// The cell of each pixel if it had the given depth, as shaders find it.
std::vector<uint32_t> cells_at_depths(Work& work, const Seen& seen, const std::vector<float>& depths);

// The cells of a light grid that pixels read: compares the depths themselves with the edges' keys
// (shared/slices.h). `view`: with the grid's slices and z-bins. `depth`: a value a pixel of the view, row 0
// at the bottom; outlives it. `tile`: side of a tile, pixels; `across`, `down`: tiles.
class PixelCells {
 public:
  PixelCells(CullView view, const std::vector<float>& depth, uint tile, uint across, uint down);
  int slice(int x, int y) const;
  uint32_t z_bin(int x, int y) const;  // 0 without z-bins
  uint32_t cell(int x, int y) const { return cell(x, y, slice(x, y)); }
  uint32_t cell(int x, int y, int slice) const;
  int width() const { return int(view_.width); }
  int height() const { return int(view_.height); }

 private:
  float key(int x, int y) const;

  CullView view_;
  const std::vector<float>& depth_;
  uint tile_, across_, down_;
  std::array<float, MOST_SLICES> slices_;
  std::array<float, MOST_Z_BINS> z_bins_;
};
PixelCells cells_of_pixels(const Seen& seen, const std::vector<float>& depth);

// The lists of a grid's cells with each pixel's cell, as the oracle reads them. With z-bins (a word a light,
// shared/slices.h), each pair of a cell and a z-bin that occurs at a pixel has its own list: the cell's
// lights that reach the bin. Entries that are no light stay.
ListedLights at_pixels(ListedLights lists, const PixelCells& cells, std::span<const uint32_t> z_bins);

}  // namespace lightgrid
