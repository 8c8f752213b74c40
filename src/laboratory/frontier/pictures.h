// The pictures of a frontier's points: one file for points that drew the same, and those that the page of one
// file shows.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/image.h"
#include "measures/flip.h"

namespace lightgrid::lab {

// Writes NAME.png, and if the picture is not the truth NAME.difference.png (logarithmic, as in `compare`)
// and, with `flip`, NAME.flip.png: HDR-FLIP from 0, black, to 1, yellow (viridis).
class PictureFiles {
 public:
  explicit PictureFiles(std::filesystem::path folder);  // created; empty: nothing is written

  void expose(const Exposure& exposure) { exposure_ = exposure; }  // the pictures that follow

  struct Written {
    std::string name;  // without extension; the same for equal pictures of a scene
    std::optional<double> flip_mean;
  };
  Written write(const std::string& scene, const Image& image, const Image& truth, const HdrFlip* flip);

 private:
  std::filesystem::path folder_;
  Exposure exposure_;
  std::map<std::string, Written> written_;
};

// A point's picture, its difference from the truth and its FLIP map: NAME.png, NAME.difference.png and
// NAME.flip.png for FrontierRecord::image NAME.
inline constexpr std::array<const char*, 3> picture_suffixes = {".png", ".difference.png", ".flip.png"};

struct PagePictures {
  std::vector<std::string> urls;  // data: URLs of WebP, each distinct picture once
  std::map<std::string, std::array<int, 3>>
      by_name;      // indices of urls by picture_suffixes; -1: there is no such file
  int reduced = 1;  // pixels a side that became one
};

// Reads the files of `names` in `folder`. At most `max_bytes` of text: first by a lower quality, then at
// 1/2, 1/3, ... 1/8 of width and height, a block becoming its mean. A file that is missing or no PNG is left
// out.
PagePictures page_pictures(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           size_t max_bytes);

}  // namespace lightgrid::lab
