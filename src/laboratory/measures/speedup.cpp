#include "measures/speedup.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "plan/settings.h"

namespace lightgrid::lab {
namespace {

// Lists count as equally long up to this factor.
constexpr double alike_lists = 1.1;

bool is_timed(const RunResult& row) { return row.frame_ms.runs > 0 && row.frame_ms.median > 0; }

bool has_pass(const RunResult& row, const PassResult& pass) {
  return std::ranges::any_of(
      row.passes, [&](const PassResult& own) { return own.name == pass.name && own.on == pass.on; });
}

double times_faster(const RunResult& row, const RunResult& than) {
  return than.frame_ms.median / row.frame_ms.median;
}

// Returns whether both are meant to show the same, with as many samples per pixel.
bool same_picture(const RunResult& a, const RunResult& b) {
  std::vector<std::string> settings(model_settings().begin(), model_settings().end());
  settings.push_back("samples");
  return std::ranges::all_of(settings, [&](const std::string& setting) {
    const auto of_a = a.settings.find(json_key(setting)), of_b = b.settings.find(json_key(setting));
    return of_a == a.settings.end() || of_b == b.settings.end() || of_a->second == of_b->second;
  });
}

// Returns whether every pass of the row in OpenCL is also one of the reference.
bool same_api(const RunResult& row, const RunResult& reference) {
  return std::ranges::all_of(
      row.passes, [&](const PassResult& pass) { return pass.on != "cl" || has_pass(reference, pass); });
}

// How far the numbers of listed pairs are apart, as a factor of 1 or more; infinite if one was not counted.
double lists_apart(const RunResult& a, const RunResult& b) {
  if (!a.pairs || !b.pairs) return std::numeric_limits<double>::infinity();
  const double x = double(a.pairs->listed) + 1, y = double(b.pairs->listed) + 1;
  return std::max(x / y, y / x);
}

// The row with the reference's passes whose lists are as long as the row's; null if there is none.
const RunResult* with_lists_of(const CompareReport& report, const RunResult& row,
                               const RunResult& reference) {
  const RunResult* best = nullptr;
  for (const RunResult& other : report.rows) {
    if (&other == &reference || !is_timed(other) || !adds_only_lists(other, reference)) continue;
    if (!same_picture(other, row) || lists_apart(other, row) > alike_lists) continue;
    if (!best || other.frame_ms.median < best->frame_ms.median) best = &other;
  }
  return best;
}

// Every light at every pixel in OpenCL, as far as the row adds only lists to it; null if it was not timed.
const RunResult* every_light_for(const CompareReport& report, const RunResult& row) {
  const auto serves = [&](const RunResult& other) {
    return is_timed(other) && draws_without_opengl(other) && same_picture(other, row) &&
           adds_only_lists(row, other);
  };
  for (const RunResult& other : report.rows) {
    const auto lights = other.settings.find("lights");
    if (lights != other.settings.end() && lights->second == "all" && serves(other)) return &other;
  }
  if (!report.own_surfaces || !report.own_surfaces->every_light) return nullptr;
  return serves(*report.own_surfaces->every_light) ? &*report.own_surfaces->every_light : nullptr;
}

}  // namespace

bool draws_without_opengl(const RunResult& row) {
  return std::ranges::none_of(row.passes, [](const PassResult& pass) { return pass.on == "gl"; });
}

bool adds_only_lists(const RunResult& row, const RunResult& every_light) {
  return std::ranges::all_of(every_light.passes, [&](const PassResult& pass) { return has_pass(row, pass); });
}

std::optional<Speedup> speedup_of(const CompareReport& report, const RunResult& row) {
  const RunResult* reference = reference_row(report);
  if (!reference || !is_timed(*reference) || !is_timed(row)) return {};
  Speedup speedup{.total = times_faster(row, *reference)};
  if (&row == reference) {
    speedup.lists = speedup.api = 1;
    return speedup;
  }
  if (!same_picture(row, *reference)) {
    speedup.other = speedup.total;
    return speedup;
  }
  if (adds_only_lists(row, *reference)) {
    speedup.lists = speedup.total;
    speedup.api = 1;
    return speedup;
  }
  const bool other_api = draws_without_opengl(row) && !draws_without_opengl(*reference);
  const RunResult* all = other_api ? every_light_for(report, row) : nullptr;
  if (all && all != &row) speedup.lists_in_opencl = times_faster(row, *all);
  if (!other_api && same_api(row, *reference)) speedup.api = 1;
  if (const RunResult* alike = with_lists_of(report, row, *reference)) {
    speedup.by = alike;
    speedup.lists = times_faster(*alike, *reference);
    (other_api ? speedup.api.emplace() : speedup.other) = times_faster(row, *alike);
  } else if (all) {
    speedup.by = all;
    speedup.lists = times_faster(row, *all);
    speedup.api = times_faster(*all, *reference);
  } else {
    speedup.other = speedup.total;
  }
  return speedup;
}

std::string software_opengl(const std::string& gl_device) {
  for (const char* driver : {"llvmpipe", "softpipe", "swrast", "SwiftShader"})
    if (gl_device.find(driver) != std::string::npos) return driver;
  return "";
}

}  // namespace lightgrid::lab
