// FLIP, an estimate of the difference seen when alternating between two images: Andersson et al., "FLIP: A
// Difference Evaluator for Alternating Images" (HPG 2020), and "Visualizing Errors in Rendered High Dynamic
// Range Images" (Eurographics Short Papers 2021). Written from the papers; held to the authors' program
// (v1.6) by tests.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/image.h"
#include "measures/results.h"

namespace lightgrid::lab {

// A display 0.7 m away, 0.7 m and 3840 pixels wide has this: the authors' default.
inline constexpr double default_pixels_per_degree = 67;

// Per pixel, row 0 at the bottom, 0 (no visible difference) to 1. Both images have one size and are linear
// RGB from 0 to 1, of which values outside are clamped. NaN in either image counts as 1 at that pixel, and as
// black in its neighbourhood.
std::vector<float> flip_map(const Image& test, const Image& reference,
                            double pixels_per_degree = default_pixels_per_degree);

// An image as FLIP compares it, for comparisons with several others. Linear RGB as in flip_map.
struct SeenImage;
class SeenByFlip {
 public:
  explicit SeenByFlip(const Image& image, double pixels_per_degree = default_pixels_per_degree);
  std::vector<float> map(const SeenByFlip& other) const;  // flip_map of the two, which are of one size

 private:
  std::shared_ptr<const SeenImage> seen_;
};

// Exposures of HDR-FLIP, in stops: `count` of them, evenly spaced.
struct FlipExposures {
  double start = 0, stop = 0;
  int count = 0;
};

// The first exposure brings the reference's brightest luminance to 0.85 after the tone map, the last its
// median luminance. The tone map is ACES (Narkowicz 2015). Empty if the median luminance is not positive or
// the largest one is not finite.
std::optional<FlipExposures> flip_exposures(const Image& reference);

// HDR-FLIP: per pixel the largest FLIP over the exposures. Linear, scene-referred images.
std::vector<float> hdr_flip_map(const Image& test, const Image& reference, const FlipExposures& exposures,
                                double pixels_per_degree = default_pixels_per_degree);

// The same with the reference's part computed once, for many images.
class HdrFlip {
 public:
  HdrFlip(const Image& reference, const FlipExposures& exposures,
          double pixels_per_degree = default_pixels_per_degree);
  std::vector<float> map(const Image& test) const;  // `test` has the reference's size

 private:
  std::function<std::vector<float>(const Image& test, int exposure)> map_at_;
  int count_ = 0;
};

double mean_of(const std::vector<float>& map);

// A map's values as colours, black where it is 0, to be stored as a heat map is.
Image flip_picture(const std::vector<float>& map, int width, int height);

// Between the pictures that PNG files show (srgb_bytes): per pixel, row 0 at the bottom, and over all.
std::vector<float> displayed_flip_map(const Image& image, const Image& reference, const Exposure& exposure);
DisplayedFlip displayed_flip_of(const std::vector<float>& map);
DisplayedFlip displayed_flip(const Image& image, const Image& reference, const Exposure& exposure = {});

// The same with the reference's part computed once, for many images.
class ShownReference {
 public:
  ShownReference(const Image& reference, const Exposure& exposure);
  DisplayedFlip flip_of(const Image& image) const;  // `image` has the reference's size

 private:
  std::function<DisplayedFlip(const Image& image)> flip_of_;
};

}  // namespace lightgrid::lab
