// The pictures of a frontier's points: one file for points that drew the same.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "base/image.h"
#include "results/flip.h"

namespace lightgrid {

// Writes NAME.png, and if the picture is not the truth NAME.difference.png (logarithmic, as in `compare`)
// and, with `flip`, NAME.flip.png: HDR-FLIP from 0, black, to 1, yellow (viridis).
class PictureFiles {
 public:
  explicit PictureFiles(std::filesystem::path folder);  // created; empty: nothing is written

  struct Written {
    std::string name;  // without extension; the same for equal pictures of a scene
    std::optional<double> flip_mean;
  };
  Written write(const std::string& scene, const Image& image, const Image& truth, const HdrFlip* flip);

 private:
  std::filesystem::path folder_;
  std::map<std::string, Written> written_;
};

}  // namespace lightgrid
