// Pictures reduced for a page: blocks of factor × factor pixels become one; blocks at the upper and right
// edges may be cut.
#pragma once

#include <cstdint>
#include <vector>

#include "base/image.h"

namespace lightgrid {

// The number of blocks along a side.
inline int blocks_along(int side, int factor) { return (side + factor - 1) / factor; }

// The mean of each block; NaN stays NaN.
Image mean_of_blocks(const Image& image, int factor);

// The largest count of each block.
std::vector<uint32_t> largest_of_blocks(const std::vector<uint32_t>& counts, int width, int height,
                                        int factor);

// For each block the pixel of `picture` where `image` differs most from `reference`; NaN counts as the
// largest difference.
Image worst_of_blocks(const Image& picture, const Image& image, const Image& reference, int factor);

}  // namespace lightgrid
