// The tables of an answer: docs/frontier_json.md.
#include <algorithm>
#include <cmath>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "frontier/record_file.h"
#include "measures/metrics.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

// The columns of all records, and those of fields that only some records have.
std::vector<CsvColumn> csv_columns(const std::vector<json>& records) {
  std::vector<CsvColumn> all;
  const auto has = [&](const std::string& field) {
    return std::ranges::any_of(records, [at = json::json_pointer(field)](const json& record) {
      return record.contains(at) && !record[at].is_null();
    });
  };
  const auto add_flip = [&](const std::string& within, const std::string& prefix) {
    add_columns(all, {"mean", "visible_share"}, within + "/displayed_flip", prefix + "displayed_flip_");
  };
  const auto add_measures = [&](const std::string& within, const std::string& prefix) {
    for (const ErrorMeasure& m : frontier_error_measures()) add_columns(all, {m.key}, within, prefix);
  };
  add_columns(all, {"row",       "commit",    "seed",         "shard",         "cl",           "gl",
                    "scene",     "label",     "technique",    "settings",      "frames",       "series",
                    "view",      "width",     "height",       "lights",        "radius_scale", "refused",
                    "runs",      "frame_ms",  "frame_ms_low", "frame_ms_high", "baseline_ms",  "ratio",
                    "ratio_low", "ratio_high"});
  add_columns(all, {"device_ms", "hand_over_ms", "copy_ms", "read_back_ms", "baseline_device_ms"});
  add_columns(all, {"cpu_ms", "baseline_cpu_ms", "frames_per_round"});
  add_columns(all, {"bytes_moved", "memory_bytes", "covered_pixels"});
  add_columns(all, {"listed", "lit", "lost", "wrong"}, "/pairs");
  add_columns(all, {"nan_pixels", "overflow"});
  for (const auto& [key, ignored] : kinds_of_error) {
    const std::string kind = key, within = "/errors/" + kind;
    add_measures(within, kind + "_");
    add_columns(all, {"flip_mean"}, within, kind + "_");
    if (kind == "model" || kind == "total") add_flip(within, kind + "_");
  }
  if (has("/errors/authored")) {
    for (const std::string kind : {"model", "total"}) {
      add_measures("/errors/authored/" + kind, "authored_" + kind + "_");
      add_flip("/errors/authored/" + kind, "authored_" + kind + "_");
    }
  }
  add_columns(all, {"bias_rmse_rel", "deviation_rmse_rel", "temporal_rmse_rel"}, "/errors");
  if (has("/errors/seeds")) {
    add_columns(all, {"pictures", "flip_pictures", "bias_mse_rel", "bias_mse_rel_error"}, "/errors/seeds",
                "seeds_");
    add_measures("/errors/seeds/deviation", "seeds_deviation_");
    all.push_back({"seeds_deviation_displayed_flip_mean", "/errors/seeds/deviation/displayed_flip/mean"});
  }
  if (has("/errors/sequences")) {
    for (const auto& [key, ignored] : sequences_of_errors) {
      for (const std::string kind : {"plain", "filtered"}) {
        const std::string within = fmt::format("/errors/sequences/{}/{}", key, kind);
        const std::string prefix = fmt::format("{}_{}_", key, kind);
        add_columns(all, {"mean", "visible_share"}, within + "/flicker", prefix + "flicker_");
        add_columns(all, {"largest_flicker"}, within, prefix);
        add_flip(within, prefix);
      }
    }
  }
  if (has("/errors/surfaces")) {
    add_measures("/errors/surfaces", "surfaces_");
    add_flip("/errors/surfaces", "surfaces_");
  }
  for (const auto& [name, index] : {std::pair{"flip_start", "0"}, {"flip_stop", "1"}, {"flip_count", "2"}})
    all.push_back({name, std::string("/flip_exposures/") + index});
  add_columns(all, {"exposure_ev", "image"});
  const std::string sampled = "/errors/in_double";
  add_columns(all, {"pixels"}, sampled, "in_double_");
  add_measures(sampled + "/picture", "in_double_");
  add_columns(all, {"max_rel", "rmse_rel"}, sampled + "/picture_in_float", "in_double_float_total_");
  add_columns(all, {"max_rel", "rmse_rel"}, sampled + "/truth", "in_double_float_truth_");
  if (has("/overlap")) add_columns(all, {"overlap", "pair_pixels"});
  if (has("/truth")) {
    add_columns(all, {"own_ranges", "shadow_source", "shadow_rays", "places"}, "/truth", "truth_");
  }
  if (has("/external")) add_columns(all, {"note", "paired"}, "/external", "external_");
  if (!has("/pairs/shadows")) return all;
  add_columns(all, {"leaked", "acned", "either"}, "/pairs/shadows");
  add_columns(all, {"pixels", "pairs"}, "/pairs/shadows", "shadow_");
  add_columns(all, {"leaked_percent", "acned_percent"});
  return all;
}

// `fields`, the record's fields as in its part, with its times as medians with intervals, and the sweep's
// fields.
json csv_row(const FrontierAnswer& answer, size_t row, json fields) {
  const FrontierRecord& r = answer.part.records[row];
  fields.update(
      {{"row", row}, {"commit", answer.part.commit}, {"seed", answer.part.seed}, {"shard", r.shard}});
  for (const FrontierMachine& machine : answer.machines) {
    if (machine.shard == r.shard) fields.update({{"cl", machine.cl_device}, {"gl", machine.gl_device}});
  }
  fields["settings"] = settings_field(r.point.settings);
  if (r.pairs.shadows) {
    fields["leaked_percent"] = ToJson{Numbers::finite}.json_of(leaked_percent(r.pairs));
    fields["acned_percent"] = ToJson{Numbers::finite}.json_of(acned_percent(r.pairs));
  }
  if (!r.refused.empty() || r.external) {
    for (const char* key : {"bytes_moved", "memory_bytes", "covered_pixels", "pairs", "overflow"})
      fields.erase(key);
  }
  if (!r.refused.empty()) {  // it drew no picture
    fields.erase("nan_pixels");
    for (const auto& [kind, ignored] : kinds_of_error) fields["errors"].erase(kind);
  }
  std::vector<double> ratios;
  for (size_t run = 0; run < r.frame_ms.size(); ++run) ratios.push_back(r.frame_ms[run] / r.baseline_ms[run]);
  const MedianInterval frame = median_interval(r.frame_ms);
  fields["runs"] = frame.runs;
  const auto add_median = [&](const ClockTimes& clock) {
    const std::vector<double>& times = r.*clock.second;
    fields[clock.first] = times.empty() ? json() : finite_number(median_interval(times).median);
  };
  std::ranges::for_each(times_by_device, add_median);
  std::ranges::for_each(times_by_cpu, add_median);
  fields["frame_ms"] = fields["baseline_ms"] = nullptr;
  if (frame.runs == 0) return fields;
  fields["baseline_ms"] = finite_number(median_interval(r.baseline_ms).median);
  for (const auto& [name, interval] : {std::pair{"frame_ms", frame}, {"ratio", median_interval(ratios)}}) {
    fields[name] = finite_number(interval.median);
    fields[std::string(name) + "_low"] = finite_number(interval.low);
    fields[std::string(name) + "_high"] = finite_number(interval.high);
  }
  return fields;
}

std::string figure(double value) { return std::isfinite(value) ? fmt::format("{}", value) : ""; }

}  // namespace

std::string csv_text(const FrontierAnswer& answer) {
  std::vector<json> records, rows;
  for (const FrontierRecord& record : answer.part.records) {
    records.push_back(ToJson{Numbers::finite}.json_of(record));
    rows.push_back(csv_row(answer, rows.size(), records.back()));
  }
  return csv_table(csv_columns(records), rows);
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
  std::string text =
      "row,run,process,frame_ms,baseline_ms,device_ms,baseline_device_ms,cpu_ms,baseline_cpu_ms\n";
  const auto of = [](const std::vector<double>& times, size_t run) {
    return run < times.size() ? figure(times[run]) : "";
  };
  for (size_t row = 0; row < answer.part.records.size(); ++row) {
    const FrontierRecord& r = answer.part.records[row];
    for (size_t run = 0; run < r.frame_ms.size(); ++run)
      text += fmt::format("{},{},{},{},{},{},{},{},{}\n", row, run,
                          run < r.processes.size() ? r.processes[run] : 0, figure(r.frame_ms[run]),
                          figure(r.baseline_ms[run]), of(r.device_ms, run), of(r.baseline_device_ms, run),
                          of(r.cpu_ms, run), of(r.baseline_cpu_ms, run));
  }
  return text;
}

}  // namespace lightgrid::lab
