// Means of random pictures, held to the picture that they should have.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/glm.hpp>

#include "base/image.h"

namespace lightgrid {

// Per pixel and channel, over images that are added.
class Moments {
 public:
  explicit Moments(size_t values) : sum_(values), squares_(values) {}
  void add(const std::vector<double>& values) {
    for (size_t i = 0; i < values.size(); ++i) {
      sum_[i] += values[i];
      squares_[i] += values[i] * values[i];
    }
    ++count_;
  }
  size_t size() const { return sum_.size(); }
  double mean(size_t i) const { return sum_[i] / count_; }
  double variance(size_t i) const {
    return std::max(squares_[i] - sum_[i] * sum_[i] / count_, 0.0) / (count_ - 1);
  }
  double standard_error(size_t i) const { return std::sqrt(variance(i) / count_); }

 private:
  std::vector<double> sum_, squares_;
  double count_ = 0;
};

inline double mean_variance(const Moments& m) {
  double sum = 0;
  for (size_t i = 0; i < m.size(); ++i) sum += m.variance(i);
  return sum / double(m.size());
}

inline double share_that_varies(const Moments& m) {
  size_t varying = 0;
  for (size_t i = 0; i < m.size(); ++i) varying += m.standard_error(i) > 1e-3 * m.mean(i);
  return double(varying) / double(m.size());
}

inline double share_within_four_errors(const Moments& m, const std::vector<double>& truth, double rounding) {
  size_t within = 0;
  for (size_t i = 0; i < m.size(); ++i)
    within += std::abs(m.mean(i) - truth[i]) <= 4 * m.standard_error(i) + rounding;
  return double(within) / double(m.size());
}

inline std::vector<double> channels(const std::vector<glm::dvec3>& radiance) {
  std::vector<double> values;
  for (const glm::dvec3& c : radiance) values.insert(values.end(), {c.r, c.g, c.b});
  return values;
}

// The channels of an image at these pixels.
inline std::vector<double> channels(const Image& image, const std::vector<uint32_t>& pixels) {
  std::vector<double> values;
  for (const uint32_t pixel : pixels) {
    const glm::vec4& color = image.pixels[pixel];
    values.insert(values.end(), {color.r, color.g, color.b});
  }
  return values;
}

}  // namespace lightgrid
