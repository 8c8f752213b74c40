#include "measures/metrics.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "base/parallel.h"
#include "measures/error_measures.h"

namespace lightgrid::lab {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr size_t pixels_at_once = 4096;
constexpr double min_channel = 1e-3;  // relative to the brightest: denominators of relative errors

bool same_bits(float a, float b) { return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b); }

// Equal infinities differ by 0; NaN counts as an infinite error.
double channel_error(double a, double b) {
  if (a == b) return 0;
  const double error = std::abs(a - b);
  return std::isnan(error) ? infinite : error;
}

// The sums of some pixels.
struct Sums {
  double luminance = 0, light = 0, reference_light = 0;  // luminance: the reference's; light: in all channels
  double squares = 0, relative_squares = 0, largest = 0;
  Sums& operator+=(const Sums& other) {
    luminance += other.luminance;
    light += other.light;
    reference_light += other.reference_light;
    squares += other.squares;
    relative_squares += other.relative_squares;
    largest = std::max(largest, other.largest);
    return *this;
  }
};

// Over all pixels, each by add(pixel, sums), on all cores. Added up in one order, whatever their number.
template <typename Add>
Sums sums_of(size_t pixels, const Add& add) {
  std::vector<Sums> runs((pixels + pixels_at_once - 1) / pixels_at_once);
  parallel_runs(pixels, pixels_at_once, [&](size_t first, size_t end) {
    Sums sums;
    for (size_t i = first; i < end; ++i) add(i, sums);
    runs[first / pixels_at_once] = sums;
  });
  return std::accumulate(runs.begin(), runs.end(), Sums(),
                         [](Sums all, const Sums& run) { return all += run; });
}

// `reference_at`: the pixel of that number.
template <typename ReferenceAt>
ImageDifference difference_of(const Image& image, const ReferenceAt& reference_at, double brightest) {
  std::vector<double> largest(image.pixels.size());
  const Sums sums = sums_of(image.pixels.size(), [&](size_t i, Sums& of_run) {
    const glm::dvec3 reference = reference_at(i);
    for (int c = 0; c < 3; ++c) {
      const double error = channel_error(image.pixels[i][c], reference[c]);
      if (error == 0) continue;
      largest[i] = std::max(largest[i], error);
      of_run.squares += error * error;
      const double over = std::max(reference[c], min_channel * brightest);
      const double relative = over > 0 ? error / over : infinite;
      of_run.relative_squares += relative * relative;
    }
    of_run.largest = std::max(of_run.largest, largest[i]);
  });
  return {.pixels = image.pixels.size(),
          .largest = sums.largest,
          .percentile_99 = percentile_99(std::move(largest)),
          .sum_of_squares = sums.squares,
          .sum_of_relative_squares = sums.relative_squares,
          .brightest = brightest};
}

constexpr double dim = 0.01;  // relative to mean luminance: least denominator for dark pixels
constexpr size_t trimmed_one_of = 1000;
constexpr int low_pass_px = 16;

// The sum over each square of low_pass_px within one channel of the image, squared, of all of them.
double low_pass_squares(const std::vector<double>& errors, int width, int height) {
  const int across = std::min(low_pass_px, width), up = std::min(low_pass_px, height);
  const size_t columns = size_t(width - across + 1);
  std::vector<double> in_rows(columns * size_t(height)), in_squares(columns, 0.0);
  double squares = 0;
  for (int y = 0; y < height; ++y) {
    const double* row = &errors[size_t(y) * size_t(width)];
    double sum = 0;
    for (int x = 0; x < width; ++x) {
      sum += row[x];
      if (x >= across) sum -= row[x - across];
      if (x >= across - 1) in_rows[size_t(y) * columns + size_t(x - across + 1)] = sum;
    }
    for (size_t x = 0; x < columns; ++x) {
      in_squares[x] += in_rows[size_t(y) * columns + x];
      if (y >= up) in_squares[x] -= in_rows[size_t(y - up) * columns + x];
      if (y >= up - 1) squares += in_squares[x] * in_squares[x];
    }
  }
  return squares;
}

// The mean square of the means over squares, from the sum of these over all channels.
double low_pass_mean_square(double squares, int width, int height) {
  const int across = std::min(low_pass_px, width), up = std::min(low_pass_px, height);
  const double pixels = double(across) * double(up),
               places = double(width - across + 1) * double(height - up + 1);
  return squares / (3 * places * pixels * pixels);
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
  const Sums light_sums = sums_of(pixels, [&](size_t i, Sums& of_run) {
    const glm::dvec3 t = reference_at(i);
    of_run.luminance += (0.2126 * t.r + 0.7152 * t.g + 0.0722 * t.b) / double(pixels);
    of_run.reference_light += t.r + t.g + t.b;
    of_run.light += double(image.pixels[i].r) + double(image.pixels[i].g) + double(image.pixels[i].b);
  });
  const double luminance = light_sums.luminance, e = dim * luminance;
  std::vector<double> rel_mse(pixels), smape(pixels), errors[3];
  for (std::vector<double>& channel : errors) channel.resize(pixels);
  const double squares = sums_of(pixels, [&](size_t i, Sums& of_run) {
                           const glm::dvec3 t = reference_at(i), x(image.pixels[i]);
                           for (int c = 0; c < 3; ++c) {
                             const double error = channel_error(x[c], t[c]);
                             if (error == 0) continue;
                             const bool finite = error < infinite;
                             errors[c][i] = finite ? x[c] - t[c] : infinite;
                             of_run.squares += errors[c][i] * errors[c][i];
                             rel_mse[i] += finite ? error * error / (t[c] * t[c] + e * e) / 3 : infinite;
                             smape[i] +=
                                 finite ? error / (std::abs(x[c]) + std::abs(t[c]) + e) / 3 : infinite;
                           }
                         }).squares;
  LightDifference light;
  const auto over = [&](double error, double of) { return error == 0 ? 0 : of > 0 ? error / of : infinite; };
  const bool has_low_pass = width > 0 && squares < infinite;
  double low_pass[3] = {};
  parallel_for(5, [&](int task) {
    if (task == 0)
      std::tie(light.rel_mse, light.rel_mse_trimmed) = means_of(std::move(rel_mse));
    else if (task == 1)
      std::tie(light.smape, light.smape_trimmed) = means_of(std::move(smape));
    else if (has_low_pass)
      low_pass[task - 2] = low_pass_squares(errors[task - 2], width, height);
  });
  if (has_low_pass) {
    const double mean = low_pass_mean_square(low_pass[0] + low_pass[1] + low_pass[2], width, height);
    light.low_pass_rmse_of_mean = over(std::sqrt(mean), luminance);
  } else if (width > 0) {
    light.low_pass_rmse_of_mean = infinite;
  }
  light.energy_rel = squares < infinite
                         ? over(light_sums.light - light_sums.reference_light, light_sums.reference_light)
                         : infinite;
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
  const auto add = [&](double step, bool border) {
    sums[border] += std::abs(step);
    pairs[border] += 1;
  };
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

void PictureMoments::add(const Image& image) {
  if (count_ == 0) {
    width_ = image.width;
    height_ = image.height;
    sum_.assign(image.pixels.size(), glm::dvec3(0));
    squares_.assign(image.pixels.size(), glm::dvec3(0));
  }
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    const glm::dvec3 color(image.pixels[i]);
    sum_[i] += color;
    squares_[i] += color * color;
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
  parallel_runs(errors.size(), pixels_at_once, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) errors[i] += glm::vec3(image.pixels[i] - truth.pixels[i]);
  });
}

// A U-statistic of the groups' means, and what it is without each of them in turn.
BiasOfPictures::Estimate BiasOfPictures::estimate() const {
  assert(count_ >= groups && count_ % groups == 0);
  double products[groups * groups] = {};  // products of a and each b < a
  parallel_for(groups * groups, [&](int pair) {
    const std::vector<glm::vec3>&a = errors_[pair / groups], &b = errors_[pair % groups];
    if (pair % groups >= pair / groups) return;
    for (size_t i = 0; i < a.size(); ++i) products[pair] += glm::dot(glm::dvec3(a[i]), glm::dvec3(b[i]));
  });
  double with_others[groups] = {}, all = 0;  // sums of products with other groups, each pair twice
  for (int a = 0; a < groups; ++a) {
    for (int b = 0; b < a; ++b) {
      const double product = products[a * groups + b];
      with_others[a] += product;
      with_others[b] += product;
      all += 2 * product;
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

}  // namespace lightgrid::lab
