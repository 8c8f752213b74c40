#include "frontier/errors.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {
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
