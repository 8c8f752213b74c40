// Noise of random ranges, and flicker.
#pragma once

#include <vector>

#include "base/image.h"

namespace lightgrid {

// The mean of pictures and how far they scatter, per channel.
class PictureMoments {
 public:
  void add(const Image& image);
  int count() const { return count_; }
  Image mean() const;
  // Root mean square, over pixels and channels, of one picture's standard deviation. At least two pictures.
  double deviation() const;

 private:
  int count_ = 0, width_ = 0, height_ = 0;
  std::vector<glm::dvec3> sum_, squares_;
};

// How much a picture's difference from the truth changes from frame to frame: flicker that the scene does not
// have.
class ChangeOfError {
 public:
  void add(const Image& image, const Image& truth);
  // Root mean square over pixels, channels and all changes; 0 before the second frame.
  double rmse() const;

 private:
  std::vector<glm::vec3> last_;
  double squares_ = 0;
  size_t channels_ = 0;
};

// The bias: the root mean square error of a mean of `count` random pictures, less the share of their scatter
// in it. 0 where the error is no larger than that share.
double bias_rmse(double rmse_of_mean, double deviation, int count);

}  // namespace lightgrid
