// A picture of a scene in double, from rays through the scene alone: for testing other renderers. No kernel,
// shader or rasteriser takes part.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "base/image.h"
#include "oracle/pixel_area.h"
#include "plan/settings.h"

namespace lightgrid::lab {

struct ReferencePicture {
  int width = 0, height = 0;
  std::vector<PixelArea> pixels;  // row 0 at the bottom

  Image image() const;
  glm::dvec3 max_doubt() const;
  size_t doubtful() const;  // pixels with any doubt
};

// places: of each pixel, as AreaOracle::at. Reads the settings of the picture that is meant, and those that say
// which surfaces cast shadows. progress: called with the share that is done, 0 to 1.
ReferencePicture reference_picture(const Scene& scene, const View& view, const Settings& settings, int places,
                                   const std::function<void(double)>& progress);

// Channels R, G, B, and doubt.* and spread.* of each (PixelArea), in 32-bit floats.
void save_reference(const std::filesystem::path& path, const ReferencePicture& picture);

}  // namespace lightgrid::lab
