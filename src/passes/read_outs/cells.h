// The cells that shading finds, for tests: not part of any technique's frame.
#pragma once

#include <functional>

#include "passes/frame.h"

namespace lightgrid {

inline constexpr uint32_t no_cell = 0xffffffffu;

// What `draw` writes at each pixel as an unsigned integer, else no_cell. Over the depth image of the last frame.
std::vector<uint32_t> indices_drawn(RenderView& v, const std::function<void()>& draw);

// Of each pixel that shows an opaque surface, else no_cell. Uses the depth image of the last frame.
std::vector<uint32_t> shaded_cells(RenderView& v);

// Of each pixel, were its depth the one given.
std::vector<uint32_t> cells_at_depths(RenderView& v, const std::vector<float>& depths);

}  // namespace lightgrid
