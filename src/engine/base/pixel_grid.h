// The samples of an image.
#pragma once

#include <compare>
#include <cstddef>

namespace lightgrid {

struct PixelGrid {
  int width = 0, height = 0;  // pixels
  int samples = 1;            // a pixel

  size_t pixels() const { return size_t(width) * size_t(height); }  // pixels of the image
  size_t values() const { return pixels() * size_t(samples); }  // size of a buffer with one value per sample
  // In such a buffer, without gaps: x fastest, rows from the bottom; the samples of a pixel follow one
  // another.
  size_t index(int x, int y, int sample = 0) const {
    return (size_t(y) * size_t(width) + size_t(x)) * size_t(samples) + size_t(sample);
  }
  auto operator<=>(const PixelGrid&) const = default;
};

}  // namespace lightgrid
