// The cells that shading finds, for tests: not part of any technique's frame.
#pragma once

#include <functional>

#include "passes/common/frame.h"

namespace lightgrid {

inline constexpr uint32_t no_cell = 0xffffffffu;

// The unsigned integer that `draw` writes at each pixel, else no_cell. Uses the depth image of the last
// frame.
std::vector<uint32_t> indices_drawn(Work& work, const Seen& seen, const std::function<void()>& draw);

// The cell of each pixel that shows an opaque surface, else no_cell. Uses the depth image of the last frame.
std::vector<uint32_t> shaded_cells(Work& work, const Seen& seen);

// The cell of the light grid that shading reads at each pixel, from the depth of the frame's surfaces.
std::vector<uint32_t> cells_of_pixels(const Seen& seen, const std::vector<float>& depth);

// The pixel's z-bin: 0 without z-bins.
std::vector<uint32_t> z_bins_of_pixels(const Seen& seen, const std::vector<float>& depth);

// The cell of each pixel if it had the given depth, as shaders find it.
std::vector<uint32_t> cells_at_depths(Work& work, const Seen& seen, const std::vector<float>& depths);

}  // namespace lightgrid
