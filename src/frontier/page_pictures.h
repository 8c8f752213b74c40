// Pictures in a page of one file: those beside it, compressed and, if need be, reduced.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lightgrid {

// A point's picture, its difference from the truth and its FLIP map: NAME.png, NAME.difference.png and
// NAME.flip.png for FrontierRecord::image NAME.
inline constexpr std::array<const char*, 3> picture_suffixes = {".png", ".difference.png", ".flip.png"};

struct PagePictures {
  std::vector<std::string> urls;  // data: URLs of WebP, each distinct picture once
  std::map<std::string, std::array<int, 3>>
      by_name;      // indices of urls by picture_suffixes; -1: there is no such file
  int reduced = 1;  // pixels a side that became one
};

// Reads the files of `names` in `folder`. At most `most_bytes` of text: first by a lower quality, then at
// 1/2, 1/3, ... 1/8 of width and height, a block becoming its mean. A file that is missing or no PNG is left
// out.
PagePictures page_pictures(const std::filesystem::path& folder, const std::vector<std::string>& names,
                           size_t most_bytes);

}  // namespace lightgrid
