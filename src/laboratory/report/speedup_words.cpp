#include "report/speedup_words.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "measures/speedup.h"
#include "measures/words.h"
#include "report/report.h"

namespace lightgrid::lab {
namespace {

constexpr double worth_a_word = 1.05;

struct Factor {
  double value;
  std::string cause;
};

// "(11.8 lights per pixel instead of 237)"; empty if the row's lists are not shorter.
std::string lights_instead(const CompareReport& report, const RunResult& row, const RunResult& reference) {
  const double own = listed_per_pixel(report, row), other = listed_per_pixel(report, reference);
  if (own < 0 || other <= own * 1.01) return "";
  return fmt::format("({} lights per pixel instead of {})", lights_number(own), lights_number(other));
}

std::string opencl_instead(const CompareReport& report) {
  return fmt::format("OpenCL instead of OpenGL{}", software_opengl(report.gl_device).empty()
                                                       ? ""
                                                       : ", which runs in software on this machine");
}

std::vector<Factor> factors_of(const CompareReport& report, const RunResult& row, const RunResult& reference,
                               const Speedup& speedup) {
  std::vector<Factor> factors;
  const std::string lights = lights_instead(report, row, reference);
  if (speedup.lists && !lights.empty()) factors.push_back({*speedup.lists, "shorter lists " + lights});
  if (speedup.api && speedup.by && *speedup.api != 1)
    factors.push_back({*speedup.api, opencl_instead(report)});
  if (speedup.lists && std::abs(std::log(speedup.other)) > std::log(worth_a_word))
    factors.push_back({speedup.other, "other differences"});
  std::ranges::stable_sort(factors, [](const Factor& a, const Factor& b) { return a.value > b.value; });
  return factors;
}

// Which of two measured gains from shorter lists a reader means is not known: both are stated if they differ.
std::string lists_in_opencl_in_words(const Speedup& speedup) {
  if (!speedup.lists || !speedup.lists_in_opencl) return "";
  const double times = *speedup.lists_in_opencl;
  if (std::abs(std::log(times / *speedup.lists)) <= std::log(worth_a_word)) return "";
  return fmt::format("; within OpenCL, shorter lists give {} times", short_number(times));
}

// The differences from the reference for which no rows isolate the contribution of each.
std::string not_isolated(const CompareReport& report, const RunResult& row, const RunResult& reference) {
  std::vector<std::string> differences;
  if (const std::string lights = lights_instead(report, row, reference); !lights.empty())
    differences.push_back("shorter lists " + lights);
  if (draws_without_opengl(row) && !draws_without_opengl(reference))
    differences.push_back(opencl_instead(report));
  if (differences.empty()) return "";
  differences.push_back("the technique's other passes");
  return fmt::format("this run does not isolate the cause; what differs is {}",
                     fmt::join(differences, ", and "));
}

// Where lists are as long as the reference's and nothing else is known: its costliest pass.
std::string costliest_pass(const CompareReport& report, const RunResult& reference) {
  const auto costliest = std::ranges::max_element(reference.passes, {}, &PassResult::median_ms);
  if (costliest == reference.passes.end()) return "";
  return fmt::format("most of {}'s frame is {} ({} ms)", report.reference, costliest->name,
                     short_number(costliest->median_ms));
}

std::string exactness(const RunResult& row) {
  if (!row.refused.empty()) return "refused";
  if (!passes_gates(row)) return "failed";
  if (!row.error) return "-";
  if (is_exact(row)) return "exact";
  const ImageError* error = light_error(row);
  return error ? "RMSE " + error_in_words(error->rmse_rel) : "not judged";
}

std::string time_with_spread(const Spread& time) {
  if (time.runs == 0) return "-";
  if (time.runs == 1) return short_number(time.median);
  return fmt::format("{} ± {}", short_number(time.median), short_number(0.5 * (time.max - time.min)));
}

// Characters, of UTF-8.
size_t width_of(const std::string& text) {
  return size_t(std::ranges::count_if(text, [](char c) { return (uint8_t(c) & 0xC0) != 0x80; }));
}

}  // namespace

std::string lights_number(double value) {
  return value >= 100 ? short_number(value) : fmt::format("{:.1f}", value);
}

double pixels_with_surfaces(const CompareReport& report) {
  return report.covered_pixels ? double(report.covered_pixels) : double(report.width) * report.height;
}

double listed_per_pixel(const CompareReport& report, const RunResult& row) {
  const double pixels = pixels_with_surfaces(report);
  if (row.pairs && pixels > 0) return double(row.pairs->listed) / pixels;
  const size_t i = size_t(&row - report.rows.data());
  if (i >= report.listed.size() || report.listed[i].empty()) return -1;
  return std::accumulate(report.listed[i].begin(), report.listed[i].end(), 0.0) / pixels;
}

std::string speedup_in_words(const CompareReport& report, const RunResult& row) {
  const RunResult* reference = reference_row(report);
  const std::optional<Speedup> speedup = speedup_of(report, row);
  if (!speedup || reference == &row) return "";
  const std::vector<Factor> factors = factors_of(report, row, *reference, *speedup);
  if (factors.empty()) {
    const std::string differs = not_isolated(report, row, *reference);
    return differs.empty() ? costliest_pass(report, *reference) : differs;
  }
  if (factors.size() == 1 && factors[0].value >= worth_a_word) return "all of it from " + factors[0].cause;
  std::vector<std::string> gains, none;
  for (const Factor& f : factors) {
    if (f.value >= worth_a_word)
      gains.push_back(fmt::format("{} times from {}", short_number(f.value), f.cause));
    else
      none.push_back(fmt::format("nothing from {}: {} times", f.cause, short_number(f.value)));
  }
  gains.insert(gains.end(), none.begin(), none.end());
  return fmt::format("{}{}", fmt::join(gains, ", "), lists_in_opencl_in_words(*speedup));
}

std::string software_opengl_in_words(const CompareReport& report) {
  const std::string driver = software_opengl(report.gl_device);
  const auto draws_in_opengl = [](const RunResult& row) {
    return row.refused.empty() && !row.passes.empty() && !draws_without_opengl(row);
  };
  if (driver.empty() || std::ranges::none_of(report.rows, draws_in_opengl)) return "";
  return fmt::format(
      "OpenGL runs in software on this machine ({}): times of techniques that draw with it say nothing about "
      "a "
      "graphics card",
      driver);
}

std::vector<std::string> contestants_table(const CompareReport& report) {
  constexpr size_t columns = 5;
  std::vector<std::array<std::string, columns>> lines = {
      {"technique", "ms per frame", "speed-up", "lights per pixel", "picture"}};
  for (const RunResult& row : report.rows) {
    const std::optional<Speedup> speedup = speedup_of(report, row);
    const double listed = listed_per_pixel(report, row);
    lines.push_back({row_name(report, row), time_with_spread(row.frame_ms),
                     speedup ? short_number(speedup->total) + "x" : "-",
                     listed >= 0 && row.refused.empty() ? lights_number(listed) : "-", exactness(row)});
  }
  std::array<size_t, columns> widths{};
  for (const auto& line : lines)
    for (size_t i = 0; i < columns; ++i) widths[i] = std::max(widths[i], width_of(line[i]));
  std::vector<std::string> table;
  for (const auto& line : lines) {
    const auto pad = [&](size_t i) { return std::string(widths[i] - width_of(line[i]), ' '); };
    std::string text = line[0] + pad(0);
    for (size_t i = 1; i + 1 < columns; ++i) text += "  " + pad(i) + line[i];
    table.push_back(text + "  " + line.back());
  }
  return table;
}

}  // namespace lightgrid::lab
