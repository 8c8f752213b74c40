#include "results/error_measures.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "results/metrics.h"

namespace lightgrid {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Equal infinities differ by 0; NaN counts as an infinite error.
double channel_error(float a, float b) {
  if (a == b) return 0;
  const double error = std::abs(double(a) - double(b));
  return std::isnan(error) ? infinity : error;
}

double max_abs(const ImageDifference& d) { return d.largest_of_all; }

double max_rel(const ImageDifference& d) {
  if (d.largest_of_all == 0) return 0;
  return d.brightest > 0 ? d.largest_of_all / d.brightest : infinity;
}

double rmse(const ImageDifference& d) {
  return std::sqrt(d.sum_of_squares / (3.0 * double(d.largest.size())));
}

// The smallest error that at least 99 of 100 pixels do not exceed.
double p99(const ImageDifference& d) {
  std::vector<double> sorted = d.largest;
  const size_t index = (sorted.size() * 99 + 99) / 100 - 1;
  std::nth_element(sorted.begin(), sorted.begin() + index, sorted.end());
  return sorted[index];
}

constexpr ErrorMeasure measures[] = {
    {"max_abs", "", &ImageError::max_abs, max_abs},
    {"max_rel", "Max error, of brightest", &ImageError::max_rel, max_rel},
    {"rmse", "RMSE", &ImageError::rmse, rmse},
    {"p99", "", &ImageError::p99, p99},
};

}  // namespace

ImageDifference::ImageDifference(const Image& image, const Image& reference)
    : image(image),
      reference(reference),
      largest(image.pixels.size()),
      brightest(brightest_channel(reference)) {
  assert(image.width == reference.width && image.height == reference.height);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double error = channel_error(image.pixels[i][c], reference.pixels[i][c]);
      largest[i] = std::max(largest[i], error);
      sum_of_squares += error * error;
    }
    largest_of_all = std::max(largest_of_all, largest[i]);
  }
}

std::span<const ErrorMeasure> error_measures() { return measures; }

}  // namespace lightgrid
