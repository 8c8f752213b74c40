#include "report/results_csv.h"

#include <fmt/format.h>

#include <cmath>

#include "results/error_measures.h"
#include "results/words.h"

namespace lightgrid {
namespace {

using Fields = std::vector<std::string>;

Fields heading() {
  Fields names = {"commit",     "cl",      "gl",      "scene",  "size",      "lights", "in_view", "technique",
                  "settings",   "row",     "refused", "min_ms", "median_ms", "max_ms", "runs",    "memory",
                  "light_grid", "gbuffer", "listed",  "lit",    "lost",      "wrong"};
  for (const ErrorMeasure& measure : error_measures()) names.emplace_back(measure.key);
  names.insert(names.end(),
               {"bit_identical", "nan_pixels", "overflow", "oracle_max_rel", "oracle_rmse_rel",
                "oracle_of_reference_max_rel", "reference_pixels", "surfaces_pixels", "surfaces_sum_rel",
                "surfaces_max_rel", "surfaces_rmse_rel", "surfaces_p99_rel"});
  return names;
}

template <typename Number>
std::string number(bool there, Number value) {
  return there ? fmt::format("{}", value) : "";
}

void add_error(Fields& fields, const std::optional<ImageError>& error) {
  const auto finite = [&](double value) { return number(error && std::isfinite(value), value); };
  const ImageError e = error.value_or(ImageError{});
  for (const ErrorMeasure& measure : error_measures()) fields.push_back(finite(e.*measure.value));
  fields.push_back(number(error.has_value(), e.bit_identical));
}

void add_oracle(Fields& fields, const std::optional<ImageError>& error) {
  const bool there = error && error->oracle;
  const OracleError o = there ? *error->oracle : OracleError{};
  for (const double value : {o.max_rel, o.rmse_rel, o.of_reference_max_rel}) {
    fields.push_back(number(there && std::isfinite(value), value));
  }
}

void add_surfaces(Fields& fields, const std::optional<ImageError>& error) {
  const bool there = error && error->surfaces;
  const SurfacesError s = there ? *error->surfaces : SurfacesError{};
  fields.push_back(number(there, s.pixels));
  for (const double value : {s.sum_rel, s.max_rel, s.rmse_rel, s.p99_rel}) {
    fields.push_back(number(there && std::isfinite(value), value));
  }
}

Fields fields_of(const CompareReport& report, const RunResult& row, const std::string& name) {
  const bool ran = row.refused.empty(), timed = row.frame_ms.runs > 0;
  std::vector<std::string> settings;
  for (const auto& [key, value] : row.settings) settings.push_back(key + "=" + value);
  const PairCounts pairs = row.pairs.value_or(PairCounts{});
  const bool counted = row.pairs.has_value();
  Fields fields = {report.commit,
                   report.cl_device,
                   report.gl_device,
                   report.scene,
                   fmt::format("{}x{}", report.width, report.height),
                   number(true, row.lights_total),
                   number(true, row.lights_in_view),
                   row.technique,
                   fmt::format("{}", fmt::join(settings, " ")),
                   name,
                   row.refused,
                   number(timed, row.frame_ms.min),
                   number(timed, row.frame_ms.median),
                   number(timed, row.frame_ms.max),
                   number(true, row.frame_ms.runs),
                   number(ran, row.memory_total),
                   number(ran, row.memory_light_grid),
                   number(ran, row.memory_gbuffer),
                   number(counted, pairs.listed),
                   number(counted, pairs.lit),
                   number(counted, pairs.lost),
                   number(counted, pairs.wrong)};
  add_error(fields, row.error);
  fields.push_back(number(ran, row.nan_pixels));
  fields.push_back(number(ran, row.overflow));
  add_oracle(fields, row.error);
  fields.push_back(number(true, report.reference_pixels));
  add_surfaces(fields, row.error);
  return fields;
}

}  // namespace

std::string results_csv(const std::vector<ReportView>& views) {
  std::string text = csv_line(heading());
  for (const ReportView& view : views) {
    const auto names = row_names(view.report);
    for (size_t i = 0; i < names.size(); ++i)
      text += csv_line(fields_of(view.report, view.report.rows[i], names[i]));
  }
  return text;
}

}  // namespace lightgrid
