// How a pixel finds its list in a grid that was read back, from a captured frame or from a run.
#pragma once

#include <array>

#include "capture/frame_file.h"
#include "reference/lit_set.h"
#include "shared/slices.h"

namespace lightgrid {

// Cells extend to the centres of their outer pixels (CullerOptions::pixel_centres).
inline constexpr double cell_inset = 0.5;

bool is_covered(const CapturedFrame& frame, int x, int y);  // shows a surface

// The cells that shading uses: compares the depths themselves with the edges' keys (shared/slices.h).
// `depth`: a value a pixel of the view, row 0 at the bottom. All outlive it.
class PixelCells {
 public:
  PixelCells(const View& view, const std::vector<float>& depth, const FrameGrid& grid);
  int slice(int x, int y) const;
  uint32_t z_bin(int x, int y) const;
  uint32_t cell(int x, int y) const { return cell(x, y, slice(x, y)); }
  uint32_t cell(int x, int y, int slice) const;

 private:
  float key(int x, int y) const;

  const std::vector<float>& depth_;
  const FrameGrid& grid_;
  CullView view_;
  std::array<float, MOST_SLICES> slices_;
  std::array<float, MOST_Z_BINS> z_bins_;
};

// The lists of the grid's cells, or its masks as lists if it has any. No pixel has a cell yet.
ListedLights lists_of_cells(const HostGrid& grid);

// The same with each pixel's cell, as the oracle reads them. With z-bins, each pair of a cell and a z-bin
// that occurs at a pixel has its own list: the cell's lights that reach the bin. Entries that are no light
// stay.
ListedLights listed_lights(const View& view, const std::vector<float>& depth, const FrameGrid& grid);
ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid);

}  // namespace lightgrid
