// Errors of pictures against a truth, in the measures of a frontier.
#pragma once

#include <vector>

#include "base/image.h"
#include "frontier/record.h"

namespace lightgrid {

// Of one size. `brightest`: the truth's brightest channel, over which errors are stated; 0: a black truth, of
// which any difference is infinitely far. Without flip_mean.
ErrorFigures error_figures(const Image& image, const Image& reference, double brightest);
// The same against pixels in double.
ErrorFigures error_figures(const Image& image, const std::vector<glm::dvec3>& reference, double brightest);

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

// The root mean square of the mean's own error, without what `count` random pictures leave in it: the bias. 0
// where the difference is no larger than that.
double bias_rmse(double rmse_of_mean, double deviation, int count);

}  // namespace lightgrid
