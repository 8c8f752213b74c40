// Differences between images, as numbers and as pictures.
#pragma once

#include "base/finite_pixels.h"
#include "measures/results.h"

namespace lightgrid::lab {

// Images of equal size; over the three colour channels. Equal infinities differ by 0. NaN in either image
// counts as an infinite error; so does, for max_rel, any difference from a reference that is entirely black.
ImageError compare_images(const Image& image, const Image& reference);
// The same relative to another brightest channel than the reference's.
ImageError compare_images(const Image& image, const Image& reference, double brightest);

// The measures of the frontier alone, over `brightest`, the truth's brightest channel. The reference may be
// a sample of pixels in double: then without the one of a low pass.
ImageError frontier_error(const Image& image, const Image& reference, double brightest);
ImageError frontier_error(const Image& image, const std::vector<glm::dvec3>& reference, double brightest);

// Over `brightest`. Images of one size; without pairs of either kind 0.
ErrorSteps error_steps(const Image& image, const Image& reference, int tile, double brightest);

// The largest finite colour channel; at least 0.
float brightest_channel(const Image& image);

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

// The bias of random pictures: how far their expected picture is from the truth. The mean over pixels and
// channels of its square is estimated without the pictures' scatter, as the mean product of the errors of
// different pictures, so that it may come out below 0; its standard error by the jackknife. Pictures are
// added up in `groups`, which are what differs then.
class BiasOfPictures {
 public:
  static constexpr int groups = 8;
  void add(const Image& image, const Image& truth);  // at least as many as groups, the same number in each
  struct Estimate {
    double mean_square = 0, standard_error = 0;
  };
  Estimate estimate() const;

 private:
  int count_ = 0;
  std::vector<glm::vec3> errors_[groups];  // sums
};

// |a - b| of the largest channel on a log scale: black is equal, then difference_ramp() from blue (1e-7 of
// the reference's brightest channel and below) to red (1 and above); white is NaN in either. Linear RGB, to
// be stored without a tone map (srgb_bytes_as_is).
Image difference_image(const Image& image, const Image& reference);

// The 99th percentile over pixels with a count, so that a few high counts do not compress a map's scale; 1
// where there is no such pixel.
uint32_t top_of_scale(std::vector<uint32_t> counts);

// Counts as colours: 0 is black, then viridis_ramp() up to `top` and above. Stored like a difference image.
Image heat_map(int width, int height, const std::vector<uint32_t>& counts, uint32_t top);

// The colours of the two above, lowest first, as sRGB bytes, for legends. 254 steps each, which with black
// and white fit a palette of 256 colours.
using Ramp = std::vector<glm::u8vec3>;
const Ramp& difference_ramp();
const Ramp& viridis_ramp();  // Smith and van der Walt 2015

// Pictures reduced for a page: blocks of factor × factor pixels become one; blocks at the upper and right
// edges may be cut. The number of blocks along a side.
inline int blocks_along(int side, int factor) { return (side + factor - 1) / factor; }

// The mean of each block; NaN stays NaN.
Image mean_of_blocks(const Image& image, int factor);

// The largest count of each block.
std::vector<uint32_t> largest_of_blocks(const std::vector<uint32_t>& counts, int width, int height,
                                        int factor);

// For each block the pixel of `picture` where `image` differs most from `reference`; NaN counts as the
// largest difference.
Image worst_of_blocks(const Image& picture, const Image& image, const Image& reference, int factor);

}  // namespace lightgrid::lab
