// A picture that is made to be looked at passes through this on its way to a display. Measured pictures have the defaults.
#pragma once

#include <filesystem>

#include "base/image.h"

namespace lightgrid {

enum class DisplayCurve { neutral, filmic };  // tone_map_neutral, or film_mapped of shared/film_curve.h

struct Display {
  Exposure exposure;
  DisplayCurve curve = DisplayCurve::neutral;
  float glow = 0;  // share of the light that spreads, 0 to 1
};

// `share` of each pixel's light spreads over the picture, as in a lens: the mean of blurs that each are twice as wide as the one
// before, up to a quarter of the picture's height (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare",
// SIGGRAPH 2014). The sum of the light stays the same, except near the picture's edges. Pixels that are not finite or
// negative spread nothing and stay as they are.
Image with_glow(const Image& image, float share);

// By extension as save_image: .exr has the linear image, without glow or curve.
void save_displayed(const std::filesystem::path& path, const Image& image, const Display& display);

}  // namespace lightgrid
