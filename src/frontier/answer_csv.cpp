// frontier.csv and samples.csv: docs/frontier_json.md#frontiercsv.
#include <fmt/format.h>

#include <cmath>

#include "frontier/answer.h"
#include "frontier/statistics.h"
#include "results/words.h"

namespace lightgrid {
namespace {

using CsvFields = std::vector<std::string>;

std::string figure(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

std::string figure(const std::optional<double>& value) { return value ? figure(*value) : ""; }

std::string settings_text(const std::map<std::string, std::string>& settings) {
  CsvFields all;
  for (const auto& [key, value] : settings) all.push_back(key + "=" + value);
  return fmt::format("{}", fmt::join(all, " "));
}

constexpr std::pair<const char*, ErrorFigures PointErrors::*> kinds_of_error[] = {
    {"model", &PointErrors::model},
    {"precision", &PointErrors::precision},
    {"technique", &PointErrors::technique},
    {"total", &PointErrors::total}};

CsvFields csv_heading() {
  CsvFields names = {"row",          "commit",        "seed",         "shard",          "cl",
                     "gl",           "scene",         "label",        "technique",      "settings",
                     "frames",       "series",        "view",         "width",          "height",
                     "lights",       "radius_scale",  "refused",      "runs",           "frame_ms",
                     "frame_ms_low", "frame_ms_high", "baseline_ms",  "ratio",          "ratio_low",
                     "ratio_high",   "bytes_moved",   "memory_bytes", "covered_pixels", "listed",
                     "lit",          "lost",          "wrong",        "nan_pixels",     "overflow"};
  for (const auto& [kind, ignored] : kinds_of_error) {
    for (const char* name : {"max_rel", "rmse_rel", "relative_rmse", "p99_rel", "flip_mean"}) {
      names.push_back(fmt::format("{}_{}", kind, name));
    }
  }
  names.insert(names.end(), {"bias_rmse_rel", "deviation_rmse_rel", "temporal_rmse_rel", "flip_start",
                             "flip_stop", "flip_count", "image", "in_double_pixels"});
  for (const char* name : {"max_rel", "rmse_rel", "relative_rmse", "p99_rel", "float_total_max_rel",
                           "float_total_rmse_rel", "float_truth_max_rel", "float_truth_rmse_rel"})
    names.push_back(fmt::format("in_double_{}", name));
  return names;
}

const FrontierMachine* machine_of_shard(const FrontierAnswer& answer, int shard) {
  for (const FrontierMachine& machine : answer.machines) {
    if (machine.shard == shard) return &machine;
  }
  return nullptr;
}

CsvFields times_of(const FrontierRecord& r) {
  std::vector<double> ratios;
  for (size_t run = 0; run < r.frame_ms.size(); ++run) ratios.push_back(r.frame_ms[run] / r.baseline_ms[run]);
  const MedianInterval frame = median_interval(r.frame_ms), ratio = median_interval(ratios);
  if (frame.runs == 0) return {"0", "", "", "", "", "", "", ""};
  return {fmt::format("{}", frame.runs),
          figure(frame.median),
          figure(frame.low),
          figure(frame.high),
          figure(median_interval(r.baseline_ms).median),
          figure(ratio.median),
          figure(ratio.low),
          figure(ratio.high)};
}

void add_errors(CsvFields& fields, const FrontierRecord& r) {
  const bool ran = r.refused.empty();
  for (const auto& [ignored, kind] : kinds_of_error) {
    const ErrorFigures& e = r.errors.*kind;
    for (const double value : {e.max_rel, e.rmse_rel, e.relative_rmse, e.p99_rel})
      fields.push_back(ran ? figure(value) : "");
    fields.push_back(figure(e.flip_mean));
  }
  fields.push_back(figure(r.errors.bias_rmse_rel));
  fields.push_back(figure(r.errors.deviation_rmse_rel));
  fields.push_back(figure(r.errors.temporal_rmse_rel));
  fields.push_back(r.flip ? figure(r.flip->start) : "");
  fields.push_back(r.flip ? figure(r.flip->stop) : "");
  fields.push_back(r.flip ? fmt::format("{}", r.flip->count) : "");
}

void add_in_double(CsvFields& fields, const std::optional<SampledErrors>& sampled) {
  if (!sampled) {
    fields.insert(fields.end(), 9, "");
    return;
  }
  fields.push_back(fmt::format("{}", sampled->pixels));
  const ErrorFigures &e = sampled->picture, &in_float = sampled->picture_in_float, &truth = sampled->truth;
  for (const double value : {e.max_rel, e.rmse_rel, e.relative_rmse, e.p99_rel, in_float.max_rel,
                             in_float.rmse_rel, truth.max_rel, truth.rmse_rel})
    fields.push_back(figure(value));
}

}  // namespace

std::string csv_text(const FrontierAnswer& answer) {
  std::string text = csv_line(csv_heading());
  size_t row = 0;
  for (const FrontierRecord& r : answer.part.records) {
    const FrontierMachine* machine = machine_of_shard(answer, r.shard);
    const auto whole = [](auto value) { return fmt::format("{}", value); };
    const auto counted = [&](uint64_t value) { return r.refused.empty() ? whole(value) : ""; };
    CsvFields fields = {whole(row++),
                        answer.part.commit,
                        whole(answer.part.seed),
                        whole(r.shard),
                        machine ? machine->cl_device : "",
                        machine ? machine->gl_device : "",
                        r.point.scene,
                        r.point.label,
                        r.point.technique,
                        settings_text(r.point.settings),
                        whole(r.point.frames),
                        r.series,
                        whole(r.view),
                        whole(r.width),
                        whole(r.height),
                        whole(r.lights),
                        figure(r.radius_scale),
                        r.refused};
    for (const std::string& field : times_of(r)) fields.push_back(field);
    for (const uint64_t count : {r.bytes_moved, r.memory_bytes, r.covered_pixels, r.pairs.listed, r.pairs.lit,
                                 r.pairs.lost, r.pairs.wrong, r.nan_pixels, r.overflow}) {
      fields.push_back(counted(count));
    }
    add_errors(fields, r);
    fields.push_back(r.image);
    add_in_double(fields, r.errors.in_double);
    text += csv_line(fields);
  }
  return text;
}

std::string cull_csv_text(const FrontierAnswer& answer) {
  std::string text = "row,round,cull_ms\n";
  for (size_t row = 0; row < answer.part.records.size(); ++row) {
    const FrontierRecord& r = answer.part.records[row];
    for (size_t round = 0; round < r.cull_ms.size(); ++round)
      text += fmt::format("{},{},{}\n", row, round, figure(r.cull_ms[round]));
  }
  return text;
}

std::string samples_csv_text(const FrontierAnswer& answer) {
  std::string text = "row,run,frame_ms,baseline_ms\n";
  for (size_t row = 0; row < answer.part.records.size(); ++row) {
    const FrontierRecord& r = answer.part.records[row];
    for (size_t run = 0; run < r.frame_ms.size(); ++run) {
      text += fmt::format("{},{},{},{}\n", row, run, figure(r.frame_ms[run]), figure(r.baseline_ms[run]));
    }
  }
  return text;
}

}  // namespace lightgrid
