// Pixels that are no finite radiance.
#pragma once

#include <algorithm>
#include <cmath>

#include "base/image.h"

namespace lightgrid {

// In a colour channel.
inline bool has_nan(const glm::vec4& pixel) {
  return std::isnan(pixel.r) || std::isnan(pixel.g) || std::isnan(pixel.b);
}

inline uint64_t count_nan_pixels(const Image& image) {
  return uint64_t(std::ranges::count_if(image.pixels, has_nan));
}

// Pixels with an infinite colour channel and no NaN: radiance past the largest float.
inline uint64_t count_inf_pixels(const Image& image) {
  return uint64_t(std::ranges::count_if(image.pixels, [](const glm::vec4& pixel) {
    return !has_nan(pixel) && (std::isinf(pixel.r) || std::isinf(pixel.g) || std::isinf(pixel.b));
  }));
}

}  // namespace lightgrid
