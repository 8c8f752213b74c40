// Differences between images, in numbers and in pictures.
#pragma once

#include "base/image.h"
#include "study/results.h"

namespace lightgrid {

// Both images of one size. NaN in either counts as an infinite error.
ImageError compare_images(const Image& image, const Image& reference);

uint64_t count_nan_pixels(const Image& image);

// |a - b| of the largest channel on a log scale: black is equal, then blue (1e-7 of the reference's brightest
// channel) to red (1 and above). Returned as linear RGB meant to be stored without a tone map.
Image difference_image(const Image& image, const Image& reference);

// Counts as colours: 0 is black, then viridis up to `top`.
Image heat_map(int width, int height, const std::vector<uint32_t>& counts, uint32_t top);

}  // namespace lightgrid
