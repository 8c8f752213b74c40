#include "results/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace lightgrid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

double channel_error(float a, float b) {
  if (a == b) return 0;
  const double error = std::abs(double(a) - double(b));
  return std::isnan(error) ? infinity : error;
}

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

bool has_nan(const glm::vec4& pixel) { return std::isnan(pixel.r) || std::isnan(pixel.g) || std::isnan(pixel.b); }

// The smallest sample that at least 99 of 100 samples do not exceed.
double p99_of(std::vector<double>& samples) {
  const size_t index = (samples.size() * 99 + 99) / 100 - 1;
  std::nth_element(samples.begin(), samples.begin() + index, samples.end());
  return samples[index];
}

}  // namespace

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

  std::vector<double> largest(image.pixels.size(), 0);
  double sum_of_squares = 0;
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float a = image.pixels[i][c], b = reference.pixels[i][c];
      const double error = channel_error(a, b);
      largest[i] = std::max(largest[i], error);
      sum_of_squares += error * error;
      result.bit_identical = result.bit_identical && same_bits(a, b);
    }
    result.max_abs = std::max(result.max_abs, largest[i]);
  }
  const double brightest = brightest_channel(reference);
  result.max_rel = result.max_abs == 0 ? 0 : brightest > 0 ? result.max_abs / brightest : infinity;
  result.rmse = std::sqrt(sum_of_squares / (3.0 * image.pixels.size()));
  result.p99 = p99_of(largest);
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
