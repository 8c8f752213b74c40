// How a pixel of a captured frame finds its list.
#pragma once

#include "frames/frame_file.h"
#include "oracle/lit_set.h"
#include "run/frames.h"

namespace lightgrid::lab {

// Cells extend to the centres of their outer pixels (CullerOptions::pixel_centres).
inline constexpr double cell_inset = 0.5;

bool is_covered(const CapturedFrame& frame, int x, int y);  // shows a surface

// The cells that shading uses. The frame outlives them.
PixelCells cells_of(const CapturedFrame& frame, const FrameGrid& grid);

// The lists of the grid's cells, or its masks as lists if it has any. No pixel has a cell yet.
ListedLights lists_of_cells(const HostGrid& grid);

// The same with each pixel's cell, as the oracle reads them.
ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid);

}  // namespace lightgrid::lab
