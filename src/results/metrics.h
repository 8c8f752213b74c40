// Differences between images, as numbers and as pictures.
#pragma once

#include "base/image.h"
#include "results/results.h"

namespace lightgrid {

// Images of equal size; over the three colour channels. Equal infinities differ by 0. NaN in either image
// counts as an infinite error; so does, for max_rel, any difference from a reference that is entirely black.
ImageError compare_images(const Image& image, const Image& reference);
// The same relative to another brightest channel than the reference's.
ImageError compare_images(const Image& image, const Image& reference, double brightest);

// The measures of the frontier alone, over `brightest`, the truth's brightest channel. The reference may be
// in double.
ImageError frontier_error(const Image& image, const Image& reference, double brightest);
ImageError frontier_error(const Image& image, const std::vector<glm::dvec3>& reference, double brightest);

bool has_nan(const glm::vec4& pixel);  // in a colour channel
uint64_t count_nan_pixels(const Image& image);

// Pixels with an infinite colour channel and no NaN: radiance past the largest float.
uint64_t count_inf_pixels(const Image& image);

// The largest finite colour channel; at least 0.
float brightest_channel(const Image& image);

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

}  // namespace lightgrid
