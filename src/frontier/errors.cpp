#include "frontier/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightgrid {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double least_channel = 1e-3;  // of the brightest: denominators of the relative error

double difference_of(double a, double b) {
  if (a == b) return 0;
  const double difference = std::abs(a - b);
  return std::isnan(difference) ? infinite : difference;
}

double over(double error, double brightest) {
  return error == 0 ? 0 : brightest > 0 ? error / brightest : infinite;
}

// `reference_at`: the pixel of that number.
template <typename ReferenceAt>
ErrorFigures figures_of_errors(const Image& image, const ReferenceAt& reference_at, double brightest) {
  std::vector<double> worst;
  double squares = 0, relative_squares = 0, largest = 0;
  worst.reserve(image.pixels.size());
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 reference = reference_at(i);
    double worst_channel = 0;
    for (int c = 0; c < 3; ++c) {
      const double error = difference_of(image.pixels[i][c], reference[c]);
      worst_channel = std::max(worst_channel, error);
      squares += error * error;
      const double relative = over(error, std::max(reference[c], least_channel * brightest));
      relative_squares += relative * relative;
    }
    worst.push_back(worst_channel);
    largest = std::max(largest, worst_channel);
  }
  ErrorFigures figures;
  if (worst.empty()) return figures;
  const double channels = 3 * double(worst.size());
  const auto p99 = worst.begin() + std::ptrdiff_t((worst.size() - 1) * 99 / 100);
  std::ranges::nth_element(worst, p99);
  figures.max_rel = over(largest, brightest);
  figures.rmse_rel = over(std::sqrt(squares / channels), brightest);
  figures.relative_rmse = std::sqrt(relative_squares / channels);
  figures.p99_rel = over(*p99, brightest);
  return figures;
}

}  // namespace

ErrorFigures error_figures(const Image& image, const Image& reference, double brightest) {
  return figures_of_errors(
      image, [&](size_t i) { return glm::dvec3(reference.pixels[i]); }, brightest);
}

ErrorFigures error_figures(const Image& image, const std::vector<glm::dvec3>& reference, double brightest) {
  return figures_of_errors(
      image, [&](size_t i) { return reference[i]; }, brightest);
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
