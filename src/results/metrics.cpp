#include "results/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "results/error_measures.h"

namespace lightgrid {
namespace {

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

}  // namespace

bool has_nan(const glm::vec4& pixel) {
  return std::isnan(pixel.r) || std::isnan(pixel.g) || std::isnan(pixel.b);
}

float brightest_channel(const Image& image) {
  float brightest = 0;
  for (const auto& pixel : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      if (std::isfinite(pixel[c])) brightest = std::max(brightest, pixel[c]);
    }
  }
  return brightest;
}

ImageError compare_images(const Image& image, const Image& reference) {
  assert(image.width == reference.width && image.height == reference.height);
  ImageError result;
  if (image.pixels.empty()) return result;

  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) result.bit_identical &= same_bits(image.pixels[i][c], reference.pixels[i][c]);
  }
  const ImageDifference difference(image, reference);
  for (const ErrorMeasure& measure : error_measures()) result.*measure.value = measure.of(difference);
  return result;
}

uint64_t count_nan_pixels(const Image& image) {
  return std::count_if(image.pixels.begin(), image.pixels.end(), has_nan);
}

uint64_t count_inf_pixels(const Image& image) {
  return std::count_if(image.pixels.begin(), image.pixels.end(), [](const glm::vec4& pixel) {
    return !has_nan(pixel) && (std::isinf(pixel.r) || std::isinf(pixel.g) || std::isinf(pixel.b));
  });
}

}  // namespace lightgrid
