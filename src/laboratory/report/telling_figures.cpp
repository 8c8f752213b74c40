#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "measures/path_changes.h"
#include "measures/relative_frames.h"
#include "measures/words.h"
#include "report/report.h"
#include "report/speedup_words.h"

namespace lightgrid::lab {
namespace {

// "12 leaked and 0 acned pairs".
std::string shadows_in_words(const ShadowPairs& shadows) {
  return fmt::format("{} leaked and {} acned pairs", with_commas(shadows.leaked), with_commas(shadows.acned));
}

// "12 lost pairs and 3 NaN pixels".
std::string failed_gates(const RunResult& row) {
  std::vector<std::string> failures;
  if (row.pairs && row.pairs->lost)
    failures.push_back(with_commas(row.pairs->lost) + " lost pairs" + why_lost(row));
  if (row.pairs && row.pairs->wrong) failures.push_back(with_commas(row.pairs->wrong) + " wrong pairs");
  if (shadow_faults(row) > 0) failures.push_back(shadows_in_words(*row.pairs->shadows));
  if (row.nan_pixels) failures.push_back(with_commas(row.nan_pixels) + " NaN pixels");
  return fmt::format("{}", fmt::join(failures, " and "));
}

std::string ms_in_words(const RunResult& row) { return short_number(row.frame_ms.median) + " ms"; }

std::string time_figure(const CompareReport& report, const RunResult& row, const RunResult* reference) {
  const Spread& time = row.frame_ms;
  const auto runs = time.runs > 1 ? fmt::format("median of {}", time.runs) : "one run";
  if (reference && reference != &row && time.median > 0 && reference->frame_ms.runs > 0) {
    const RelativeFrames relative = relative_frames(times_of(row), times_of(*reference));
    return fmt::format("{} is {} times faster than {}: {} against {} per frame ({}{})", row_name(report, row),
                       short_number(reference->frame_ms.median / time.median), report.reference,
                       ms_in_words(row), ms_in_words(*reference), runs,
                       relative.has_interval() ? "; " + relative.in_words() : "");
  }
  return fmt::format("{} takes {} per frame ({})", row_name(report, row), ms_in_words(row), runs);
}

std::string error_clause(const ImageError& error) {
  return fmt::format("by RMSE {} and at most {} of the brightest channel", error_in_words(error.rmse_rel),
                     error_in_words(error.max_rel));
}

// "its light is every light's on its own surfaces (visibility:lights=all), bit for bit".
std::string light_clause(const CompareReport& report, const RunResult& row) {
  const ImageError* error = light_error(row);
  const bool other_surfaces = row.own_surfaces && report.own_surfaces;
  if (!error && row.error) {
    return fmt::format("not known to be exact ({}): its image differs from {}'s {}",
                       report.own_surfaces ? report.own_surfaces->why_not : "not measured", report.reference,
                       error_clause(*row.error));
  }
  if (!error) return "";
  const std::string every_light =
      fmt::format("every light at every pixel{} ({})", other_surfaces ? " of its own surfaces" : "",
                  other_surfaces ? every_light_on(true) : report.reference);
  if (error->bit_identical) return "exact: the image of " + every_light + ", bit for bit";
  return fmt::format("{}: its image differs from that of {} {}",
                     is_exact(row) ? "exact within rounding" : "not exact", every_light,
                     error_clause(*error));
}

std::string lights_figure(const CompareReport& report, const RunResult& row) {
  auto line = fmt::format("lights per pixel: {} listed", lights_number(listed_per_pixel(report, row)));
  if (row.pairs) {
    const double lit = double(row.pairs->lit) / pixels_with_surfaces(report);
    line += fmt::format(", {} lit, {} lost", lights_number(lit), with_commas(row.pairs->lost));
    if (row.pairs->wrong) line += fmt::format(", {} wrong", with_commas(row.pairs->wrong));
    if (const auto& shadows = row.pairs->shadows)
      line += fmt::format("; shadows: {}, {} undecided, at {} pixels", shadows_in_words(*shadows),
                          with_commas(shadows->either), with_commas(shadows->pixels));
    if (const auto& blended = row.pairs->blended)
      line += fmt::format("; on blended surfaces {} leaked and {} acned", with_commas(blended->leaked),
                          with_commas(blended->acned));
  }
  return line;
}

// For the terminal: at how many pixels the two rasterisers show another triangle.
std::string surfaces_in_short(const CompareReport& report) {
  if (!report.own_surfaces || !report.own_surfaces->error || !report.own_surfaces->error->silhouettes)
    return "";
  const uint64_t pixels = report.own_surfaces->error->silhouettes->silhouettes;
  return fmt::format("the rasterisers of OpenCL and OpenGL show the same triangles except at {} of {} pixels",
                     with_commas(pixels), with_commas(uint64_t(report.width) * uint64_t(report.height)));
}

// How far surfaces drawn in OpenCL are from OpenGL's, and whose are nearer to those in double.
std::string surfaces_figure(const CompareReport& report) {
  if (!report.own_surfaces || !report.own_surfaces->error) return "";
  const ImageError& error = *report.own_surfaces->error;
  std::string line = fmt::format("surfaces drawn in OpenCL, apart from light, differ from {}'s {}",
                                 report.reference, error_clause(error));
  if (error.silhouettes && error.silhouettes->silhouettes)
    line += fmt::format("; {} {} another triangle", with_commas(error.silhouettes->silhouettes),
                        error.silhouettes->silhouettes == 1 ? "pixel shows" : "pixels show");
  const auto& own = error.surfaces;
  const auto& reference = report.reference_surfaces;
  if (!own || !reference || own->pixels == 0) return line;
  const double a = own->rmse_rel, b = reference->rmse_rel;
  return line + fmt::format("; their RMSE against surfaces in double is {}, {}'s {}{}", error_in_words(a),
                            report.reference, error_in_words(b),
                            a < b   ? ": OpenCL's are nearer"
                            : b < a ? fmt::format(": {}'s are nearer", report.reference)
                                    : "");
}

// The share of pixels at which the pictures as displayed may differ, for nobody to tell them apart.
constexpr double max_visible = 1e-4;

bool looks_exact(const RunResult& row) {
  const ImageError* error = light_error(row);
  const bool faultless =
      row.refused.empty() && row.nan_pixels == 0 &&
      (!row.pairs || (row.pairs->wrong == 0 && row.pairs->lost == row.overflow && shadow_faults(row) == 0));
  return faultless &&
         (is_exact(row) || (error && error->displayed && error->displayed->visible <= max_visible));
}

// How sure it is that `row` is the fastest of those that `counts` accepts: its time relative to the next.
std::string how_sure(const CompareReport& report, const RunResult& row, const RowTest& counts) {
  const Spread& time = row.frame_ms;
  if (time.runs < 2) return "one frame makes no interval: --frames 5 gives one";
  const std::string words =
      fmt::format("{} to {} ms in {} frames", short_number(time.min), short_number(time.max), time.runs);
  const RunResult* next =
      fastest(report, [&](const RunResult& other) { return &other != &row && counts(other); });
  if (!next) return words;
  const std::string name = fmt::format("{} ({})", row_name(report, *next), ms_in_words(*next));
  const RelativeFrames relative = relative_frames(times_of(row), times_of(*next));
  if (relative.frames == 0) return words;
  return fmt::format("{}: {} the next, {}: {}", words,
                     relative.is_faster() ? "surely faster than" : "not surely faster than", name,
                     relative.in_words());
}

Choice fastest_choice(const CompareReport& report, const char* what, const RunResult& row,
                      const RowTest& counts) {
  return {what, row_name(report, row), ms_in_words(row), "", how_sure(report, row, counts)};
}

std::string visible_in_words(const RunResult& row) {
  const ImageError* error = light_error(row);
  if (!error || !error->displayed) return "";
  return fmt::format("FLIP of the pictures as displayed is above {} at {:.2g} % of the pixels", visible_flip,
                     100 * error->displayed->visible);
}

// Quicker than the best, and why it does not count.
std::string quicker_figure(const CompareReport& report, const RunResult& row) {
  const std::string name = fmt::format("{} is quicker ({}) but ", row_name(report, row), ms_in_words(row));
  const std::string light = light_clause(report, row);
  if (!passes_gates(row)) return name + "has " + failed_gates(row) + (light.empty() ? "" : "; " + light);
  const std::string visible = visible_in_words(row);
  return name + light + (visible.empty() ? "" : "; " + visible);
}

bool quicker(const RunResult* row, const RunResult* than) {
  return row && row != than && (!than || row->frame_ms.median < than->frame_ms.median);
}

// Passes all gates but is not exact.
const RunResult* fastest_lossy(const CompareReport& report) {
  return fastest(report, [](const RunResult& row) { return passes_gates(row) && !is_exact(row); });
}

// The row that the figures describe: the fastest exact one, or else the best one; null if nothing was timed.
const RunResult* best_row(const CompareReport& report) {
  for (const RunResult* row : {fastest_exact(report), fastest_lossy(report)}) {
    if (row) return row;
  }
  return fastest(report, [](const RunResult&) { return true; });
}

}  // namespace

const RunResult* fastest(const CompareReport& report, const RowTest& counts) {
  const RunResult* best = nullptr;
  for (const RunResult& row : report.rows) {
    const bool timed = row.frame_ms.runs > 0;
    if (timed && counts(row) && (!best || row.frame_ms.median < best->frame_ms.median)) best = &row;
  }
  return best;
}

uint64_t shadow_faults(const RunResult& row) {
  if (!row.pairs) return 0;
  return (row.pairs->shadows ? row.pairs->shadows->faults() : 0) +
         (row.pairs->blended ? row.pairs->blended->faults() : 0);
}

bool passes_gates(const RunResult& row) {
  return row.refused.empty() && row.nan_pixels == 0 && row.unshaded.value_or(0) <= max_unshaded &&
         (!row.pairs || (row.pairs->lost == 0 && row.pairs->wrong == 0 && shadow_faults(row) == 0));
}

bool is_exact(const ImageError& error) {
  if (error.bit_identical) return true;
  if (!error.oracle) return error.max_rel <= exact_max_rel;
  const double of_reference = error.oracle->of_reference_max_rel;
  const double most = exact_factor * std::max(of_reference, exact_floor);
  return error.oracle->max_rel <= most && error.max_rel <= std::max(exact_max_rel, of_reference + most);
}

bool is_exact(const RunResult& row) {
  const ImageError* error = light_error(row);
  return passes_gates(row) && (!row.error || is_exact(error ? *error : *row.error));
}

const RunResult* fastest_exact(const CompareReport& report) {
  return fastest(report, [](const RunResult& row) { return is_exact(row); });
}

std::string why_lost(const RunResult& row) {
  if (row.overflow == 0) return "";
  std::vector<std::string> caps;
  for (const std::string of : {"list", "view"}) {
    const std::string cap = setting_in_force(row.settings, of + "_cap");
    if (!cap.empty()) caps.push_back("a " + of + " has room for " + cap);
  }
  if (!caps.empty()) return fmt::format(" by design ({} lights)", fmt::join(caps, ", "));
  const auto room = row.settings.find("lidr_overlap");
  const bool told = room != row.settings.end() && room->second != "auto";
  return fmt::format(" by design (a pixel has room for {} lights)",
                     told ? room->second : "a limited number of");
}

namespace {

std::vector<std::string> remarks_with(const CompareReport& report, const std::string& surfaces) {
  const RunResult* best = best_row(report);
  if (!best) return {};
  std::vector<std::string> lines;
  if (const std::string software = software_opengl_in_words(report); !software.empty())
    lines.push_back(software);
  if (listed_per_pixel(report, *best) >= 0) lines.push_back(lights_figure(report, *best));
  if (!surfaces.empty()) lines.push_back(surfaces);
  const RunResult* failing = fastest(report, [](const RunResult& row) { return !passes_gates(row); });
  for (const RunResult* row : {fastest_lossy(report), failing}) {
    if (quicker(row, best) && row->error) lines.push_back(quicker_figure(report, *row));
  }
  if (const std::string changes = plan_changes_in_words(report); !changes.empty()) lines.push_back(changes);
  return lines;
}

}  // namespace

std::vector<std::string> remarks(const CompareReport& report) {
  return remarks_with(report, surfaces_figure(report));
}

std::vector<std::string> telling_figures(const CompareReport& report) {
  const RunResult* best = best_row(report);
  if (!best) return {};
  const RunResult* reference = reference_row(report);
  std::vector<std::string> lines = {time_figure(report, *best, reference)};
  if (const std::string why = speedup_in_words(report, *best); !why.empty()) lines.push_back(why);
  if (const std::string light = light_clause(report, *best); !light.empty() && best != reference)
    lines.push_back(light);
  for (std::string& line : remarks_with(report, surfaces_in_short(report))) lines.push_back(std::move(line));
  return lines;
}

std::string verdict(const CompareReport& report) {
  const RunResult *row = fastest_exact(report), *best = best_row(report), *reference = reference_row(report);
  if (!best) return "Nothing was timed.";
  const std::string name = row_name(report, *best);
  if (!passes_gates(*best)) return fmt::format("No technique passes: {} has {}.", name, failed_gates(*best));
  if (!row)
    return fmt::format("No technique is exact: {} is the fastest that fails no gate, {} per frame; {}.", name,
                       ms_in_words(*best), light_clause(report, *best));
  if (!reference || reference->frame_ms.runs == 0)
    return fmt::format("{} is the fastest exact technique.", name);
  if (reference == row) {
    const RunResult* next =
        fastest(report, [&](const RunResult& other) { return &other != reference && is_exact(other); });
    return fmt::format(
        "Nothing exact beats {}{}.", name,
        next ? fmt::format("; {} comes next at {}", row_name(report, *next), ms_in_words(*next)) : "");
  }
  const std::string why = speedup_in_words(report, *row);
  return fmt::format("{} is the fastest exact technique, {} times faster than {}{}{}.", name,
                     short_number(reference->frame_ms.median / std::max(row->frame_ms.median, 1e-9)),
                     report.reference, why.empty() ? "" : ": ", why);
}

std::vector<Choice> choices(const CompareReport& report) {
  std::vector<Choice> all;
  const RowTest exact = [](const RunResult& row) { return is_exact(row); };
  const RunResult *row = fastest_exact(report), *alike = fastest(report, looks_exact);
  if (row) {
    Choice& choice = all.emplace_back(fastest_choice(report, "Fastest exact", *row, exact));
    choice.why = light_clause(report, *row);
  }
  if (alike) {
    Choice& choice =
        all.emplace_back(fastest_choice(report, "Fastest visually lossless", *alike, looks_exact));
    choice.why =
        alike == row ? "nothing faster is indistinguishable from every light" : visible_in_words(*alike);
    if (alike->overflow) choice.why += "; it has " + failed_gates(*alike);
    const std::string rule = fmt::format("FLIP as displayed may be above {} at one pixel of {}", visible_flip,
                                         with_commas(uint64_t(1 / max_visible)));
    choice.sure = alike == row ? rule : rule + "; " + choice.sure;
  }
  const RunResult *least = nullptr, *next = nullptr;
  for (const RunResult& other : report.rows) {
    if (!is_exact(other) || other.memory_total == 0) continue;
    if (!least || other.memory_total < least->memory_total) {
      next = least;
      least = &other;
    } else if (!next || other.memory_total < next->memory_total)
      next = &other;
  }
  if (least) {
    Choice& choice = all.emplace_back(
        Choice{"Least memory, exact", row_name(report, *least), bytes_in_words(least->memory_total), "", ""});
    choice.why = fmt::format("{} per frame", ms_in_words(*least));
    if (next)
      choice.why += fmt::format("; the next, {}, takes {}", row_name(report, *next),
                                bytes_in_words(next->memory_total));
    choice.sure = "counted by allocations";
  }
  return all;
}

}  // namespace lightgrid::lab
