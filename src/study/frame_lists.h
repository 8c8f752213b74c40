// How a pixel of a captured frame finds its list.
#pragma once

#include "reference/lit_set.h"
#include "study/frame_file.h"

namespace lightgrid {

// Cells reach to the centres of their outer pixels (CullerOptions::pixel_centres).
inline constexpr double cell_inset = 0.5;

bool is_covered(const CapturedFrame& frame, int x, int y);  // a surface is there

// 0 where nothing is.
int slice_of_pixel(const CapturedFrame& frame, const FrameGrid& grid, int x, int y);

// The grid's lists as the oracle reads them.
ListedLights listed_lights(const CapturedFrame& frame, const FrameGrid& grid);

}  // namespace lightgrid
