#include "report/view_pictures.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/parallel.h"
#include "base/write_file.h"
#include "measures/error_measures.h"
#include "measures/metrics.h"
#include "report/report.h"

namespace lightgrid::lab {
namespace {

namespace fs = std::filesystem;
using Png = std::vector<uint8_t>;

constexpr int max_reduced = 16;

bool has_image(const CompareReport& report, size_t row) { return !image_of(report, row).pixels.empty(); }

bool has_counts(const CompareReport& report, size_t row) {
  return row < report.listed.size() && !report.listed[row].empty();
}

// One scale for all heat maps, so that they are comparable: the largest of their 99th percentiles. A
// technique that lists the same count at every covered pixel (every light, say) is excluded, since its scale
// would flatten all others.
uint32_t heat_top(const CompareReport& report) {
  uint32_t top = 0, flat_top = 1;
  const auto consider = [&](const std::vector<uint32_t>& counts) {
    uint32_t low = ~0u, high = 0;
    for (uint32_t count : counts) {
      if (count) {
        low = std::min(low, count);
        high = std::max(high, count);
      }
    }
    if (low >= high) flat_top = std::max(flat_top, high);
    if (low < high) top = std::max({top, percentile_99(counts), 1u});
  };
  for (size_t i = 0; i < report.rows.size(); ++i) {
    if (has_counts(report, i)) consider(report.listed[i]);
  }
  consider(report.lit);
  return top ? top : flat_top;
}

Png picture_png(const Image& image, const Exposure& exposure, int reduced) {
  const Image small = reduced > 1 ? mean_of_blocks(image, reduced) : Image();
  const Image& shown = reduced > 1 ? small : image;
  return encode_png(shown.width, shown.height, 3, srgb_bytes(shown, exposure));
}

Png difference_png(const Image& image, const Image& reference, int reduced) {
  Image difference = difference_image(image, reference);
  if (reduced > 1) difference = worst_of_blocks(difference, image, reference, reduced);
  return encode_png(difference.width, difference.height, 3, srgb_bytes_as_is(difference));
}

HeatMap make_heat_map(const CompareReport& report, const std::vector<uint32_t>& counts, uint32_t top,
                      int reduced) {
  const int width = blocks_along(report.width, reduced), height = blocks_along(report.height, reduced);
  const auto picture =
      heat_map(width, height, largest_of_blocks(counts, report.width, report.height, reduced), top);
  return {encode_png(width, height, 3, srgb_bytes_as_is(picture)),
          std::accumulate(counts.begin(), counts.end(), 0.0) /
              double(report.covered_pixels ? report.covered_pixels : counts.size()),
          *std::max_element(counts.begin(), counts.end())};
}

// All pictures, by the names of their files.
void write_pictures(const fs::path& folder, const CompareReport& report, const ReportPictures& pictures) {
  const auto write = [&](const std::string& name, const Png& png) {
    if (!png.empty()) write_file(folder / name, png);
  };
  const auto stems = file_stems(row_names(report));
  for (size_t i = 0; i < stems.size(); ++i) {
    const RowPictures& row = pictures.rows[i];
    write(stems[i] + ".png", row.image);
    write(stems[i] + ".difference.png", row.difference);
    if (row.listed) write(stems[i] + ".heat.png", row.listed->png);
  }
  write(file_stem(report.reference) + ".png", pictures.reference);
  if (pictures.lit) write("lit.heat.png", pictures.lit->png);
}

void write_exr_files(const fs::path& folder, const CompareReport& report) {
  const auto stems = file_stems(row_names(report));
  parallel_for(int(stems.size()), [&](int i) {
    if (has_image(report, i)) save_exr(folder / (stems[i] + ".exr"), image_of(report, size_t(i)));
  });
  const Image& reference = reference_image(report);
  if (&reference == &report.reference_image && !reference.pixels.empty()) {
    save_exr(folder / (file_stem(report.reference) + ".exr"), reference);
  }
}

}  // namespace

ReportPictures make_pictures(const CompareReport& report, int reduced) {
  const Image& reference = reference_image(report);
  const auto names = row_names(report);
  ReportPictures pictures{.heat_top = heat_top(report), .reduced = reduced};
  pictures.rows.resize(report.rows.size());
  parallel_for(int(report.rows.size()), [&](int i) {
    RowPictures& row = pictures.rows[i];
    row.name = names[i];
    if (has_image(report, i)) {
      const Image& image = image_of(report, size_t(i));
      row.image = picture_png(image, report.exposure, reduced);
      if (!reference.pixels.empty()) row.difference = difference_png(image, reference, reduced);
    }
    if (has_counts(report, i))
      row.listed = make_heat_map(report, report.listed[i], pictures.heat_top, reduced);
  });
  if (&reference == &report.reference_image && !reference.pixels.empty()) {
    pictures.reference = picture_png(reference, report.exposure, reduced);
  }
  if (!report.lit.empty()) pictures.lit = make_heat_map(report, report.lit, pictures.heat_top, reduced);
  return pictures;
}

size_t bytes_in_page(const ReportPictures& pictures) {
  std::set<Png> distinct = {pictures.reference};
  if (pictures.lit) distinct.insert(pictures.lit->png);
  for (const RowPictures& row : pictures.rows) {
    distinct.insert({row.image, row.difference});
    if (row.listed) distinct.insert(row.listed->png);
  }
  size_t bytes = 0;
  for (const Png& png : distinct) bytes += (png.size() + 2) / 3 * 4;  // base64
  return bytes;
}

ReportPictures save_pictures(const fs::path& folder, const CompareReport& report, bool exr,
                             size_t max_bytes) {
  make_folder(folder);
  ReportPictures pictures = make_pictures(report, 1);
  write_pictures(folder, report, pictures);
  if (exr) write_exr_files(folder, report);
  while (max_bytes && pictures.reduced < max_reduced && bytes_in_page(pictures) > max_bytes) {
    // Bytes grow with the area, or slightly more slowly.
    const double excess = double(bytes_in_page(pictures)) / double(max_bytes);
    const int next = std::max(pictures.reduced + 1, int(pictures.reduced * std::sqrt(excess)));
    pictures = make_pictures(report, std::min(next, max_reduced));
  }
  return pictures;
}

}  // namespace lightgrid::lab
