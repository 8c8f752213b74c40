#include "results/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

#include "results/error_measures.h"

namespace lightgrid {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double least_channel = 1e-3;  // of the brightest: denominators of relative errors

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

// Equal infinities differ by 0; NaN counts as an infinite error.
double channel_error(double a, double b) {
  if (a == b) return 0;
  const double error = std::abs(a - b);
  return std::isnan(error) ? infinite : error;
}

// `reference_at`: the pixel of that number.
template <typename ReferenceAt>
ImageDifference difference_of(const Image& image, const ReferenceAt& reference_at, double brightest) {
  ImageDifference difference{.pixels = image.pixels.size(), .brightest = brightest};
  std::vector<double> largest(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 reference = reference_at(i);
    for (int c = 0; c < 3; ++c) {
      const double error = channel_error(image.pixels[i][c], reference[c]);
      largest[i] = std::max(largest[i], error);
      difference.sum_of_squares += error * error;
      if (error == 0) continue;
      const double over = std::max(reference[c], least_channel * brightest);
      const double relative = over > 0 ? error / over : infinite;
      difference.sum_of_relative_squares += relative * relative;
    }
    difference.largest = std::max(difference.largest, largest[i]);
  }
  difference.percentile_99 = percentile_99(std::move(largest));
  return difference;
}

template <typename ReferenceAt>
ImageError measured(const Image& image, const ReferenceAt& reference_at, double brightest,
                    std::span<const ErrorMeasure> measures) {
  ImageError result;
  if (image.pixels.empty()) return result;
  const ImageDifference difference = difference_of(image, reference_at, brightest);
  for (const ErrorMeasure& measure : measures) result.*measure.value = measure.of(difference);
  return result;
}

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
  return compare_images(image, reference, brightest_channel(reference));
}

ImageError compare_images(const Image& image, const Image& reference, double brightest) {
  assert(image.width == reference.width && image.height == reference.height);
  ImageError result = measured(
      image, [&](size_t i) { return glm::dvec3(reference.pixels[i]); }, brightest, error_measures());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) result.bit_identical &= same_bits(image.pixels[i][c], reference.pixels[i][c]);
  }
  return result;
}

ImageError frontier_error(const Image& image, const Image& reference, double brightest) {
  const auto reference_at = [&](size_t i) { return glm::dvec3(reference.pixels[i]); };
  return measured(image, reference_at, brightest, frontier_error_measures());
}

ImageError frontier_error(const Image& image, const std::vector<glm::dvec3>& reference, double brightest) {
  const auto reference_at = [&](size_t i) { return reference[i]; };
  return measured(image, reference_at, brightest, frontier_error_measures());
}

uint64_t count_nan_pixels(const Image& image) {
  return std::count_if(image.pixels.begin(), image.pixels.end(), has_nan);
}

uint64_t count_inf_pixels(const Image& image) {
  return std::count_if(image.pixels.begin(), image.pixels.end(), [](const glm::vec4& pixel) {
    return !has_nan(pixel) && (std::isinf(pixel.r) || std::isinf(pixel.g) || std::isinf(pixel.b));
  });
}

void PictureMoments::add(const Image& image) {
  if (count_ == 0) {
    width_ = image.width, height_ = image.height;
    sum_.assign(image.pixels.size(), glm::dvec3(0));
    squares_.assign(image.pixels.size(), glm::dvec3(0));
  }
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 color(image.pixels[i]);
    sum_[i] += color, squares_[i] += color * color;
  }
  ++count_;
}

Image PictureMoments::mean() const {
  Image image(width_, height_);
  for (size_t i = 0; i < sum_.size(); ++i)
    image.pixels[i] = glm::vec4(glm::vec3(sum_[i] / double(count_)), 1);
  return image;
}

double PictureMoments::deviation() const {
  if (count_ < 2 || sum_.empty()) return 0;
  double variances = 0;
  for (size_t i = 0; i < sum_.size(); ++i) {
    const glm::dvec3 variance =
        glm::max(squares_[i] - sum_[i] * sum_[i] / double(count_), 0.0) / double(count_ - 1);
    variances += variance.r + variance.g + variance.b;
  }
  return std::sqrt(variances / (3 * double(sum_.size())));
}

void ChangeOfError::add(const Image& image, const Image& truth) {
  std::vector<glm::vec3> difference;
  difference.reserve(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) difference.emplace_back(image.pixels[i] - truth.pixels[i]);
  for (size_t i = 0; i < last_.size(); ++i) {
    const glm::dvec3 change = glm::dvec3(difference[i]) - glm::dvec3(last_[i]);
    squares_ += glm::dot(change, change);
    channels_ += 3;
  }
  last_ = std::move(difference);
}

double ChangeOfError::rmse() const { return channels_ > 0 ? std::sqrt(squares_ / double(channels_)) : 0; }

double bias_rmse(double rmse_of_mean, double deviation, int count) {
  return std::sqrt(std::max(rmse_of_mean * rmse_of_mean - deviation * deviation / std::max(count, 1), 0.0));
}

}  // namespace lightgrid
