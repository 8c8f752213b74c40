// The pictures of one view: files beside the report, and what its page shows of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measures/results.h"

namespace lightgrid::lab {

struct HeatMap {
  std::vector<uint8_t> png;
  double mean = 0;  // lights a pixel that shows a surface
  uint32_t max = 0;
};

// PNG files; empty if missing.
struct RowPictures {
  std::string name;  // distinct
  std::vector<uint8_t> image, difference;
  std::optional<HeatMap> listed;
};

struct ReportPictures {
  std::vector<RowPictures> rows;   // in the order of the report's rows
  std::vector<uint8_t> reference;  // if no row is the reference
  std::optional<HeatMap> lit;
  uint32_t heat_top = 1;  // upper end of every heat map's scale
  int reduced = 1;        // pixels a side of the view that become one
};

// At 1/reduced of the size, the last blocks cut. A block becomes its mean in a picture, its worst pixel in a
// difference, its largest count in a heat map, so that no fault is hidden.
ReportPictures make_pictures(const CompareReport& report, int reduced);

// Bytes of all distinct pictures as text in a page.
size_t bytes_in_page(const ReportPictures& pictures);

// Writes the pictures (report.h), with .exr files if requested, and returns what a page of at most
// `max_bytes` shows: reduced as far as necessary, and at most 16 times. 0: no limit.
ReportPictures save_pictures(const std::filesystem::path& folder, const CompareReport& report, bool exr,
                             size_t max_bytes);

}  // namespace lightgrid::lab
