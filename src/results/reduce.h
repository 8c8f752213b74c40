// Pictures made smaller for a page: blocks of factor × factor pixels become one, those at the upper edges cut.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lightgrid {

// How many blocks there are along a side.
inline int blocks_along(int side, int factor) { return (side + factor - 1) / factor; }

// The mean of each block; NaN stays NaN.
Image mean_of_blocks(const Image& image, int factor);

// The largest count of each block.
std::vector<uint32_t> largest_of_blocks(const std::vector<uint32_t>& counts, int width, int height, int factor);

// Of each block the pixel of `picture` at which `image` is farthest from `reference`, NaN being the farthest.
Image worst_of_blocks(const Image& picture, const Image& image, const Image& reference, int factor);

}  // namespace lightgrid
