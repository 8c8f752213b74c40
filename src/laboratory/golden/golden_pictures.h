// Pixels stored beside the hashes of golden.h, and the pictures of a view that differs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "golden/golden.h"
#include "measures/picture_pixel.h"
#include "measures/results.h"

namespace lightgrid::lab {

// An EXR file with the channels R, G and B (radiance), depth, lists and triangles: what golden_view(pixels)
// hashes, so that viewers show the picture.
void save_golden_pixels(const std::filesystem::path& path, const GoldenPixels& pixels);

// None if there is no such file; also, with a warning, if it is none of the above or its pixels do not have
// the recorded hashes.
std::optional<GoldenPixels> load_golden_pixels(const std::filesystem::path& path, const GoldenView& recorded);

// The first pixel, row by row from the upper left, of the first tile that differs.
PicturePixel first_pixel(const GoldenPixels& recorded, const GoldenPixels& drawn, const GoldenView& view,
                         const GoldenDifference& difference);

// The pictures of a view that differs. Without recorded pixels only its tiles.
struct GoldenPictures {
  const GoldenView& recorded_view;
  const GoldenView& drawn_view;
  const GoldenDifference& difference;
  const GoldenPixels& drawn;
  const std::optional<GoldenPixels>& recorded;
  Exposure exposure;  // exposure of both pictures

  std::optional<DisplayedFlip> flip() const;  // between the two as PNG files show them

  // Into `folder`: NAME.drawn.exr and .png; NAME.STAGE.png, white where the first stage that differs does;
  // with recorded pixels NAME.expected.png, .difference.png (difference_image) and .flip.png too.
  void save(const std::filesystem::path& folder, const std::string& name) const;
};

}  // namespace lightgrid::lab
