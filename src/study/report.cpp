#include "study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/parallel.h"
#include "base/write_file.h"
#include "study/metrics.h"
#include "study/report_page.h"

namespace lightgrid {
namespace {

namespace fs = std::filesystem;

bool has_image(const CompareReport& report, size_t row) {
  return row < report.images.size() && !report.images[row].pixels.empty();
}

bool has_counts(const CompareReport& report, size_t row) {
  return row < report.listed.size() && !report.listed[row].empty();
}

uint32_t p99_of(std::vector<uint32_t> counts) {
  const size_t index = (counts.size() * 99 + 99) / 100 - 1;
  std::nth_element(counts.begin(), counts.begin() + index, counts.end());
  return counts[index];
}

// One scale for all heat maps, so that they compare: the largest of their 99th percentiles. A technique that lists
// the same count wherever anything is (every light, say) is left out, since its scale would flatten all others.
uint32_t heat_top(const CompareReport& report) {
  uint32_t top = 0, flat_top = 1;
  const auto consider = [&](const std::vector<uint32_t>& counts) {
    uint32_t low = ~0u, high = 0;
    for (uint32_t count : counts) {
      if (count) low = std::min(low, count), high = std::max(high, count);
    }
    if (low >= high) flat_top = std::max(flat_top, high);
    if (low < high) top = std::max({top, p99_of(counts), 1u});
  };
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (has_counts(report, i)) consider(report.listed[i]);
  }
  consider(report.lit);
  return top ? top : flat_top;
}

HeatMap make_heat_map(const CompareReport& report, const std::vector<uint32_t>& counts, uint32_t top) {
  const auto picture = heat_map(report.width, report.height, counts, top);
  return {encode_png(report.width, report.height, 3, srgb_bytes_as_is(picture)),
          std::accumulate(counts.begin(), counts.end(), 0.0) / counts.size(),
          *std::max_element(counts.begin(), counts.end())};
}

const Image& reference_image(const CompareReport& report) {
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (report.rows[i].technique == report.reference && has_image(report, i)) return report.images[i];
  }
  return report.reference_image;
}

// Writes NAME.png and NAME.exr; the PNG file is given back.
std::vector<uint8_t> save_picture(const fs::path& folder, const std::string& name, const Image& image) {
  const auto png = encode_png(image.width, image.height, 3, srgb_bytes(image));
  write_file(folder / (name + ".png"), png);
  save_exr(folder / (name + ".exr"), image);
  return png;
}

}  // namespace

std::string json_text(const CompareReport& report) { return json_text(to_json(report)); }

void write_report(const fs::path& folder, const CompareReport& report) {
  make_folder(folder);
  const Image& reference = reference_image(report);
  const auto names = row_names(report), stems = file_stems(names);

  ReportPictures pictures;
  pictures.heat_top = heat_top(report);
  pictures.rows.resize(report.rows.size());
  parallel_for(static_cast<int>(report.rows.size()), [&](int i) {
    auto& row = pictures.rows[i];
    row.name = names[i];
    if (has_image(report, i)) {
      const auto& image = report.images[i];
      row.image = save_picture(folder, stems[i], image);
      if (!reference.pixels.empty()) {
        const auto difference = difference_image(image, reference);
        row.difference = encode_png(image.width, image.height, 3, srgb_bytes_as_is(difference));
        write_file(folder / (stems[i] + ".difference.png"), row.difference);
      }
    }
    if (has_counts(report, i)) {
      row.listed = make_heat_map(report, report.listed[i], pictures.heat_top);
      write_file(folder / (stems[i] + ".heat.png"), row.listed->png);
    }
  });
  if (&reference == &report.reference_image && !reference.pixels.empty()) {
    pictures.reference = save_picture(folder, report.reference, reference);
  }
  if (!report.lit.empty()) {
    pictures.lit = make_heat_map(report, report.lit, pictures.heat_top);
    write_file(folder / "lit.heat.png", pictures.lit->png);
  }
  write_file(folder / "results.json", json_text(to_json(report)));
  write_file(folder / "index.html", report_page(report, pictures));
}

}  // namespace lightgrid
