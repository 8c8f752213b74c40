#include "results/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "results/error_measures.h"

namespace lightgrid {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr size_t pixels_at_once = 4096;
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
  std::vector<double> largest(image.pixels.size()), squares(image.pixels.size()),
      relative_squares(image.pixels.size());
  parallel_runs(image.pixels.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const glm::dvec3 reference = reference_at(i);
      for (int c = 0; c < 3; ++c) {
        const double error = channel_error(image.pixels[i][c], reference[c]);
        if (error == 0) continue;
        largest[i] = std::max(largest[i], error);
        squares[i] += error * error;
        const double over = std::max(reference[c], least_channel * brightest);
        const double relative = over > 0 ? error / over : infinite;
        relative_squares[i] += relative * relative;
      }
    }
  });
  for (size_t i = 0; i < largest.size(); ++i) {
    difference.sum_of_squares += squares[i];
    difference.sum_of_relative_squares += relative_squares[i];
    difference.largest = std::max(difference.largest, largest[i]);
  }
  difference.percentile_99 = percentile_99(std::move(largest));
  return difference;
}

constexpr double dim = 0.01;  // of the mean luminance: what relative errors of dark pixels are over
constexpr size_t trimmed_one_of = 1000;
constexpr int low_pass_px = 16;

// The sum of each `window` values beside each other, `stride` apart from the first of `count`.
void add_up(const double* values, size_t stride, int count, int window, double* sums, size_t sum_stride) {
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    sum += values[size_t(i) * stride];
    if (i >= window) sum -= values[size_t(i - window) * stride];
    if (i >= window - 1) sums[size_t(i - window + 1) * sum_stride] = sum;
  }
}

// The mean square of the means over each square of low_pass_px within the image.
double low_pass_mean_square(const std::vector<glm::dvec3>& errors, int width, int height) {
  const int across = std::min(low_pass_px, width), up = std::min(low_pass_px, height);
  const int columns = width - across + 1, rows = height - up + 1;
  std::vector<double> channel(errors.size()), in_rows(size_t(columns) * size_t(height)),
      in_squares(size_t(columns) * size_t(rows));
  double squares = 0;
  for (int c = 0; c < 3; ++c) {
    for (size_t i = 0; i < errors.size(); ++i) channel[i] = errors[i][c];
    for (int y = 0; y < height; ++y)
      add_up(&channel[size_t(y) * size_t(width)], 1, width, across, &in_rows[size_t(y) * size_t(columns)], 1);
    for (int x = 0; x < columns; ++x)
      add_up(&in_rows[size_t(x)], size_t(columns), height, up, &in_squares[size_t(x)], size_t(columns));
    for (const double sum : in_squares) squares += sum * sum;
  }
  const double pixels = double(across) * double(up);
  return squares / (3 * double(in_squares.size()) * pixels * pixels);
}

// Their mean, and that without the largest thousandth.
std::pair<double, double> means_of(std::vector<double> values) {
  const size_t kept = values.size() - values.size() / trimmed_one_of;
  std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(kept - 1));
  const double small = std::accumulate(values.begin(), values.begin() + std::ptrdiff_t(kept), 0.0);
  const double large = std::accumulate(values.begin() + std::ptrdiff_t(kept), values.end(), 0.0);
  return {(small + large) / double(values.size()), small / double(kept)};
}

// `width`, `height`: of an image; 0: of a sample of pixels.
template <typename ReferenceAt>
LightDifference light_difference_of(const Image& image, const ReferenceAt& reference_at, int width,
                                    int height) {
  const size_t pixels = image.pixels.size();
  double luminance = 0, sum = 0, reference_sum = 0, squares = 0;
  for (size_t i = 0; i < pixels; ++i) {
    const glm::dvec3 t = reference_at(i);
    luminance += (0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b) / double(pixels);
    reference_sum += t.r + t.g + t.b;
    sum += double(image.pixels[i].r) + double(image.pixels[i].g) + double(image.pixels[i].b);
  }
  const double e = dim * luminance;
  std::vector<double> rel_mse(pixels), smape(pixels);
  std::vector<glm::dvec3> errors(pixels);
  parallel_runs(pixels, pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const glm::dvec3 t = reference_at(i), x(image.pixels[i]);
      for (int c = 0; c < 3; ++c) {
        const double error = channel_error(x[c], t[c]);
        if (error == 0) continue;
        errors[i][c] = error < infinite ? x[c] - t[c] : infinite;
        rel_mse[i] += error < infinite ? error * error / (t[c] * t[c] + e * e) / 3 : infinite;
        smape[i] += error < infinite ? error / (std::abs(x[c]) + std::abs(t[c]) + e) / 3 : infinite;
      }
    }
  });
  for (const glm::dvec3& error : errors) squares += glm::dot(error, error);
  LightDifference light;
  const auto over = [&](double error, double of) { return error == 0 ? 0 : of > 0 ? error / of : infinite; };
  parallel_for(3, [&](int measure) {
    if (measure == 0) {
      std::tie(light.rel_mse, light.rel_mse_trimmed) = means_of(std::move(rel_mse));
    } else if (measure == 1) {
      std::tie(light.smape, light.smape_trimmed) = means_of(std::move(smape));
    } else if (width > 0) {
      light.low_pass_rmse_of_mean =
          squares < infinite ? over(std::sqrt(low_pass_mean_square(errors, width, height)), luminance)
                             : infinite;
    }
  });
  light.energy_rel = squares < infinite ? over(sum - reference_sum, reference_sum) : infinite;
  light.rmse_of_mean = over(std::sqrt(squares / (3.0 * double(pixels))), luminance);
  return light;
}

ImageError measured(const ImageDifference& difference, std::span<const ErrorMeasure> measures) {
  ImageError result;
  for (const ErrorMeasure& measure : measures) result.*measure.value = measure.of(difference);
  return result;
}

// `width`, `height`: of an image; 0: of a sample of pixels.
template <typename ReferenceAt>
ImageError measured_for_frontier(const Image& image, const ReferenceAt& reference_at, double brightest,
                                 int width, int height) {
  if (image.pixels.empty()) return {};
  ImageDifference difference = difference_of(image, reference_at, brightest);
  difference.light = light_difference_of(image, reference_at, width, height);
  return measured(difference, frontier_error_measures());
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
  ImageError result;
  if (!image.pixels.empty()) {
    const auto reference_at = [&](size_t i) { return glm::dvec3(reference.pixels[i]); };
    result = measured(difference_of(image, reference_at, brightest), error_measures());
  }
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) result.bit_identical &= same_bits(image.pixels[i][c], reference.pixels[i][c]);
  }
  return result;
}

ImageError frontier_error(const Image& image, const Image& reference, double brightest) {
  const auto reference_at = [&](size_t i) { return glm::dvec3(reference.pixels[i]); };
  return measured_for_frontier(image, reference_at, brightest, image.width, image.height);
}

ImageError frontier_error(const Image& image, const std::vector<glm::dvec3>& reference, double brightest) {
  const auto reference_at = [&](size_t i) { return reference[i]; };
  return measured_for_frontier(image, reference_at, brightest, 0, 0);
}

ErrorSteps error_steps(const Image& image, const Image& reference, int tile, double brightest) {
  const auto error = [&](int x, int y) {
    const glm::dvec4 e = glm::dvec4(image.at(x, y)) - glm::dvec4(reference.at(x, y));
    return e.r + e.g + e.b;
  };
  double sums[2] = {}, pairs[2] = {};
  const auto add = [&](double step, bool border) { sums[border] += std::abs(step), pairs[border] += 1; };
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double here = error(x, y);
      if (x > 0) add(here - error(x - 1, y), x % tile == 0);
      if (y > 0) add(here - error(x, y - 1), y % tile == 0);
    }
  }
  const auto mean = [&](bool border) {
    const double mean = sums[border] / std::max(pairs[border], 1.0) / brightest;
    return std::isfinite(mean) ? mean : 0;
  };
  return {mean(true), mean(false)};
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

void BiasOfPictures::add(const Image& image, const Image& truth) {
  std::vector<glm::vec3>& errors = errors_[count_++ % groups];
  errors.resize(image.pixels.size(), glm::vec3(0));
  for (size_t i = 0; i < errors.size(); ++i) errors[i] += glm::vec3(image.pixels[i] - truth.pixels[i]);
}

// A U-statistic of the groups' means, and what it is without each of them in turn.
BiasOfPictures::Estimate BiasOfPictures::estimate() const {
  assert(count_ >= groups && count_ % groups == 0);
  double with_others[groups] = {}, all = 0;  // sums of products with other groups, each pair twice
  for (int a = 0; a < groups; ++a) {
    for (int b = 0; b < a; ++b) {
      double product = 0;
      for (size_t i = 0; i < errors_[a].size(); ++i)
        product += glm::dot(glm::dvec3(errors_[a][i]), glm::dvec3(errors_[b][i]));
      with_others[a] += product, with_others[b] += product, all += 2 * product;
    }
  }
  constexpr double n = groups;
  const double share = n / double(count_), channels = 3 * double(errors_[0].size()),
               of_one = share * share / channels;
  double mean = 0, squares = 0, without[groups];
  for (int a = 0; a < groups; ++a) {
    without[a] = (all - 2 * with_others[a]) / ((n - 1) * (n - 2)) * of_one;
    mean += without[a] / n;
  }
  for (const double w : without) squares += (w - mean) * (w - mean);
  return {all / (n * (n - 1)) * of_one, std::sqrt((n - 1) / n * squares)};
}

}  // namespace lightgrid
