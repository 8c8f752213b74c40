#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "report/report.h"
#include "results/path_changes.h"
#include "results/words.h"

namespace lightgrid {
namespace {

std::string lights_number(double value) {
  return value >= 100 ? short_number(value) : fmt::format("{:.1f}", value);
}

std::string failed_gates(const RunResult& row) {
  std::vector<std::string> failures;
  if (row.pairs && row.pairs->lost) failures.push_back(with_commas(row.pairs->lost) + " lost pairs");
  if (row.pairs && row.pairs->wrong) failures.push_back(with_commas(row.pairs->wrong) + " wrong pairs");
  if (row.nan_pixels) failures.push_back(with_commas(row.nan_pixels) + " NaN pixels");
  return fmt::format("{}", fmt::join(failures, " and "));
}

// Passes all gates but is not exact.
const RunResult* fastest_lossy(const CompareReport& report) {
  return fastest(report, [](const RunResult& row) { return passes_gates(row) && !is_exact(row); });
}

const RunResult* fastest_of_all(const CompareReport& report) {
  return fastest(report, [](const RunResult&) { return true; });
}

size_t index_of(const CompareReport& report, const RunResult& row) { return &row - report.rows.data(); }

// Mean over the pixels; negative if not counted.
double listed_per_pixel(const CompareReport& report, const RunResult& row) {
  const double pixels = double(report.width) * report.height;
  if (row.pairs && pixels > 0) return row.pairs->listed / pixels;
  const size_t i = index_of(report, row);
  if (i >= report.listed.size() || report.listed[i].empty()) return -1;
  return std::accumulate(report.listed[i].begin(), report.listed[i].end(), 0.0) / report.listed[i].size();
}

std::string time_figure(const CompareReport& report, const RunResult& row, const RunResult* reference) {
  const auto& time = row.frame_ms;
  const auto runs = time.runs > 1 ? fmt::format("median of {}", time.runs) : "one run";
  if (reference && reference != &row && time.median > 0 && reference->frame_ms.runs > 0) {
    return fmt::format("{} is {} times faster than {}: {} ms against {} ms a frame ({})",
                       row_name(report, row), short_number(reference->frame_ms.median / time.median),
                       report.reference, short_number(time.median), short_number(reference->frame_ms.median),
                       runs);
  }
  return fmt::format("{} takes {} ms a frame ({})", row_name(report, row), short_number(time.median), runs);
}

bool same_colour(const glm::vec4& a, const glm::vec4& b) {
  for (int c = 0; c < 3; ++c) {
    if (std::bit_cast<uint32_t>(a[c]) != std::bit_cast<uint32_t>(b[c])) return false;
  }
  return true;
}

// "3 of 153 pixels differ", or empty if an image is absent.
std::string differing_pixels(const CompareReport& report, size_t a, size_t b) {
  const auto &first = image_of(report, a).pixels, &second = image_of(report, b).pixels;
  if (first.empty() || first.size() != second.size()) return "";
  const auto same =
      std::inner_product(first.begin(), first.end(), second.begin(), size_t(0), std::plus<>(), same_colour);
  return fmt::format("{} of {} pixels differ", with_commas(first.size() - same), with_commas(first.size()));
}

std::string image_figure(const CompareReport& report, const RunResult& row, const RunResult& reference) {
  const auto pixels = differing_pixels(report, index_of(report, row), index_of(report, reference));
  if (row.error->bit_identical) {
    return fmt::format("images are bit-identical{}{}", pixels.empty() ? "" : ": ", pixels);
  }
  return fmt::format("images differ: {}by at most {:.1e} of the brightest channel; absolute RMSE {:.1e}",
                     pixels.empty() ? "" : pixels + ", ", row.error->max_rel, row.error->rmse);
}

std::string lights_figure(const CompareReport& report, const RunResult& row) {
  auto line = fmt::format("lights per pixel: {} listed", lights_number(listed_per_pixel(report, row)));
  if (row.pairs) {
    const double pixels = double(report.width) * report.height;
    line += fmt::format(", {} lit, {} lost", lights_number(row.pairs->lit / pixels),
                        with_commas(row.pairs->lost));
    if (row.pairs->wrong) line += fmt::format(", {} wrong", with_commas(row.pairs->wrong));
  }
  return line;
}

std::string why_faster(const CompareReport& report, const RunResult& row, const RunResult& reference) {
  const double own = listed_per_pixel(report, row), other = listed_per_pixel(report, reference);
  if (own >= 0 && other > own * 1.05) {
    return fmt::format("because it goes through {} lights a pixel where {} goes through {}",
                       lights_number(own), report.reference, lights_number(other));
  }
  const auto costliest = std::max_element(reference.passes.begin(), reference.passes.end(),
                                          [](auto& a, auto& b) { return a.median_ms < b.median_ms; });
  if (costliest == reference.passes.end()) return "";
  return fmt::format("most of {}'s frame is {} ({} ms)", report.reference, costliest->name,
                     short_number(costliest->median_ms));
}

std::string error_in_words(const RunResult& row) {
  return fmt::format("differs by at most {:.1e} of the brightest channel", row.error->max_rel);
}

std::string image_clause(const RunResult& row) {
  if (!row.error) return "";
  if (row.error->bit_identical) return "; its image is the same to the last bit";
  return "; its image " + error_in_words(row);
}

std::string fastest_clause(const CompareReport& report, const RunResult& row) {
  return fmt::format("{} is the fastest at {} ms a frame", row_name(report, row),
                     short_number(row.frame_ms.median));
}

std::string unbeaten_clause(const CompareReport& report, const RunResult& reference) {
  const auto* next =
      fastest(report, [&](const RunResult& row) { return &row != &reference && is_exact(row); });
  if (!next) return fastest_clause(report, reference);
  return fmt::format("Nothing beats {}: {} ms a frame; {} comes next at {} ms", report.reference,
                     short_number(reference.frame_ms.median), row_name(report, *next),
                     short_number(next->frame_ms.median));
}

// Other exact techniques with a run that was as fast: their order is uncertain.
std::string close_clause(const CompareReport& report, const RunResult& winner) {
  std::vector<std::string> close;
  for (const RunResult& row : report.rows) {
    if (&row == &winner || !is_exact(row) || row.frame_ms.runs == 0 ||
        row.frame_ms.min > winner.frame_ms.median)
      continue;
    close.push_back(fmt::format("{} ({} ms)", row_name(report, row), short_number(row.frame_ms.median)));
  }
  return close.empty() ? "" : fmt::format(". Within the spread of the runs is {}", fmt::join(close, ", "));
}

std::string winner_clause(const CompareReport& report, const RunResult& row, const RunResult& reference) {
  const auto why = why_faster(report, row, reference);
  const double ratio = reference.frame_ms.median / std::max(row.frame_ms.median, 1e-9);
  return fmt::format("{} wins: {} ms a frame, {} times faster than {}{}{}{}", row_name(report, row),
                     short_number(row.frame_ms.median), short_number(ratio), report.reference,
                     why.empty() ? "" : ", ", why, image_clause(row));
}

// The fastest of those that fail a gate.
std::string failing_clause(const CompareReport& report, const RunResult& row) {
  const bool visible = row.error && !is_exact(*row.error);
  return fmt::format(". {} is quicker still ({} ms) but has {}{}", row_name(report, row),
                     short_number(row.frame_ms.median), failed_gates(row),
                     visible ? ", and its image " + error_in_words(row) : "");
}

std::string lossy_clause(const CompareReport& report, const RunResult& row) {
  return fmt::format(". {} is quicker ({} ms) but lossy: its image {}", row_name(report, row),
                     short_number(row.frame_ms.median), error_in_words(row));
}

// The sentence for a technique whose picture is another one: "visibility draws 34 frames a second (29.4 ms);
// its image differs by …".
std::string other_picture_figure(const CompareReport& report, const RunResult& row) {
  return fmt::format("{} draws {} frames a second ({} ms); its image {}", row_name(report, row),
                     short_number(1000 / std::max(row.frame_ms.median, 1e-9)),
                     short_number(row.frame_ms.median), error_in_words(row));
}

bool quicker(const RunResult* row, const RunResult& than) {
  return row && row->frame_ms.median < than.frame_ms.median;
}

}  // namespace

bool passes_gates(const RunResult& row) {
  return row.refused.empty() && row.nan_pixels == 0 &&
         (!row.pairs || (row.pairs->lost == 0 && row.pairs->wrong == 0));
}

bool is_exact(const ImageError& error) {
  if (error.bit_identical) return true;
  if (!error.oracle) return error.max_rel <= exact_max_rel;
  const double of_reference = error.oracle->of_reference_max_rel;
  const double most = exact_factor * std::max(of_reference, exact_floor);
  return error.oracle->max_rel <= most && error.max_rel <= std::max(exact_max_rel, of_reference + most);
}

bool is_exact(const RunResult& row) { return passes_gates(row) && (!row.error || is_exact(*row.error)); }

const RunResult* fastest(const CompareReport& report, const RowTest& counts) {
  const RunResult* best = nullptr;
  for (const auto& row : report.rows) {
    const bool timed = row.frame_ms.runs > 0;
    if (timed && counts(row) && (!best || row.frame_ms.median < best->frame_ms.median)) best = &row;
  }
  return best;
}

const RunResult* fastest_exact(const CompareReport& report) {
  return fastest(report, [](const RunResult& row) { return is_exact(row); });
}

std::vector<std::string> telling_figures(const CompareReport& report) {
  const auto* row = fastest_exact(report);
  if (!row) row = fastest_lossy(report);
  if (!row) row = fastest_of_all(report);
  if (!row) return {};
  const auto* reference = reference_row(report);
  std::vector<std::string> lines = {time_figure(report, *row, reference)};
  if (reference && reference != row && row->error) lines.push_back(image_figure(report, *row, *reference));
  if (listed_per_pixel(report, *row) >= 0) lines.push_back(lights_figure(report, *row));
  const auto* lossy = fastest_lossy(report);
  if (lossy != row && quicker(lossy, *row) && lossy->error)
    lines.push_back(other_picture_figure(report, *lossy));
  if (const std::string changes = plan_changes_in_words(report); !changes.empty()) lines.push_back(changes);
  return lines;
}

std::string verdict(const CompareReport& report) {
  const auto *quickest = fastest_of_all(report), *lossy = fastest_lossy(report), *row = fastest_exact(report);
  const auto* failing = fastest(report, [](const RunResult& r) { return !passes_gates(r); });
  if (!quickest) return "Nothing was timed.";
  if (!row && !lossy) {
    return fmt::format("No technique passes: {} has {}.", row_name(report, *quickest),
                       failed_gates(*quickest));
  }
  if (!row) {
    const auto text = fmt::format(
        "No technique is exact: {} is the fastest that fails no gate, {} ms a frame, but its image {}",
        row_name(report, *lossy), short_number(lossy->frame_ms.median), error_in_words(*lossy));
    return text + (quicker(failing, *lossy) ? failing_clause(report, *failing) : "") + ".";
  }
  const auto* reference = reference_row(report);
  auto text = !reference || reference->frame_ms.runs == 0 ? fastest_clause(report, *row)
              : reference == row                          ? unbeaten_clause(report, *row)
                                                          : winner_clause(report, *row, *reference);
  if (row != reference) text += close_clause(report, *row);
  if (quicker(lossy, *row)) text += lossy_clause(report, *lossy);
  if (quicker(failing, *row)) text += failing_clause(report, *failing);
  return text + ".";
}

}  // namespace lightgrid
