// How a pixel of a captured frame finds its list.
#pragma once

#include <array>

#include "reference/lit_set.h"
#include "shared/slices.h"
#include "capture/frame_file.h"

namespace lightgrid {

// Cells reach to the centres of their outer pixels (CullerOptions::pixel_centres).
inline constexpr double cell_inset = 0.5;

bool is_covered(const CapturedFrame& frame, int x, int y);  // a surface is there

// The cells that shading takes: by the depths themselves, compared with the edges' (shared/slices.h).
class PixelCells {
 public:
  PixelCells(const CapturedFrame& frame, const FrameGrid& grid);
  int slice(int x, int y) const;      // 0 where nothing is
  uint32_t z_bin(int x, int y) const;
  uint32_t cell(int x, int y) const;

 private:
  const CapturedFrame& frame_;
  const FrameGrid& grid_;
  CullView view_;
  std::array<float, MOST_SLICES> slices_;
  std::array<float, MOST_Z_BINS> z_bins_;
};

// The grid's lists, or its masks where it has some, as the oracle reads them; without lights that z-bins pass over.
ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid);

}  // namespace lightgrid
