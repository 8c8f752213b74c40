// The pictures of one view: files beside the report, and what its page shows of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "results/results.h"

namespace lightgrid {

struct HeatMap {
  std::vector<uint8_t> png;
  double mean = 0;  // lights a pixel, of the whole picture
  uint32_t max = 0;
};

// As PNG files; empty where there is none.
struct RowPictures {
  std::string name;  // distinct
  std::vector<uint8_t> image, difference;
  std::optional<HeatMap> listed;
};

struct ReportPictures {
  std::vector<RowPictures> rows;   // as the report's rows
  std::vector<uint8_t> reference;  // where no row is the reference
  std::optional<HeatMap> lit;
  uint32_t heat_top = 1;  // the count at the upper end of every heat map's colors
  int reduced = 1;        // pixels a side of the view that are one here
};

// At 1/reduced of the size, the last blocks cut. A block is its mean in a picture, its worst pixel in a difference, its
// largest count in a heat map: none hides a fault.
ReportPictures make_pictures(const CompareReport& report, int reduced);

// Bytes of all distinct pictures, as text in a page.
size_t bytes_in_page(const ReportPictures& pictures);

// Writes the pictures (report.h), with .exr files where they are asked for, and gives what a page of at most
// `most_bytes` shows: reduced as far as that takes, and at most 16 times. 0: no limit.
ReportPictures save_pictures(const std::filesystem::path& folder, const CompareReport& report, bool exr, size_t most_bytes);

}  // namespace lightgrid
