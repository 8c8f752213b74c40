// The page of a comparison: one self-contained HTML file made of study/report/* and the figures.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/results.h"

namespace lightgrid {

struct HeatMap {
  std::vector<uint8_t> png;
  double mean = 0;  // lights a pixel
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
  uint32_t heat_top = 1;  // the count at the upper end of every heat map's colours
};

// Loads nothing from elsewhere. Holds results.json as it is in <script id="results">, so that both tell the
// same figures, and each distinct picture once.
std::string report_page(const CompareReport& report, const ReportPictures& pictures);

}  // namespace lightgrid
