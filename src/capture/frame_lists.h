// How a pixel of a captured frame finds its list.
#pragma once

#include <array>

#include "reference/lit_set.h"
#include "shared/slices.h"
#include "capture/frame_file.h"

namespace lightgrid {

// Cells extend to the centres of their outer pixels (CullerOptions::pixel_centres).
inline constexpr double cell_inset = 0.5;

bool is_covered(const CapturedFrame& frame, int x, int y);  // shows a surface

// The cells that shading uses: compares the depths themselves with the edges' keys (shared/slices.h).
class PixelCells {
 public:
  PixelCells(const CapturedFrame& frame, const FrameGrid& grid);
  int slice(int x, int y) const;      // 0 for background
  uint32_t z_bin(int x, int y) const;
  uint32_t cell(int x, int y) const;

 private:
  const CapturedFrame& frame_;
  const FrameGrid& grid_;
  CullView view_;
  std::array<float, MOST_SLICES> slices_;
  std::array<float, MOST_Z_BINS> z_bins_;
};

// The grid's lists, or its masks if it has any, as the oracle reads them; without lights that z-bins skip.
ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid);

}  // namespace lightgrid
