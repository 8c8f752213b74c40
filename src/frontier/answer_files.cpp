#include "frontier/answer_files.h"

#include <cmath>

#include "base/error.h"
#include "base/write_file.h"
#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "frontier/pictures.h"
#include "frontier/record_file.h"
#include "frontier/statistics.h"
#include "results/words.h"

namespace lightgrid {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

template <typename Items, typename Text>
json array_of(const Items& items, Text text) {
  json array = json::array();
  for (const auto& item : items) array.push_back(text(item));
  return array;
}

template <typename T>
json finite_json(const T& value) {
  return ToJson{Numbers::finite}.json_of(value);
}

json pair_json(double first, double second) { return {finite_number(first), finite_number(second)}; }

json interval_json(const MedianInterval& i) {
  if (i.runs == 0) return {{"median", nullptr}, {"ci95", {nullptr, nullptr}}, {"runs", 0}};
  return {{"median", finite_number(i.median)}, {"ci95", pair_json(i.low, i.high)}, {"runs", i.runs}};
}

// The picture's own figures, and some of the two others under their names.
json in_double_json(const SampledErrors& sampled) {
  json figures = finite_json(sampled.picture);
  figures.erase("flip_mean");
  figures["pixels"] = sampled.pixels;
  for (const auto& [of, error] :
       {std::pair{"float_total_", sampled.picture_in_float}, {"float_truth_", sampled.truth}}) {
    figures[std::string(of) + "max_rel"] = finite_number(error.max_rel);
    figures[std::string(of) + "rmse_rel"] = finite_number(error.rmse_rel);
  }
  return figures;
}

json point_json(const PointFigures& p) {
  json out = finite_json(p.point);
  out["views"] = p.views;
  out["size"] = p.width > 0 ? json{p.width, p.height} : json();
  out["frame_ms"] = interval_json(p.frame_ms);
  out["ratio"] = interval_json(p.ratio);
  json& error = out["error"] = finite_json(p.errors);
  error["in_double"] = p.errors.in_double ? in_double_json(*p.errors.in_double) : json();
  error["flip_views"] = p.flip_views;
  error["temporal_views"] = p.temporal_views;
  out["pairs"] = finite_json(p.pairs);
  out["listed_per_lit"] = p.pairs.lit > 0 ? json(double(p.pairs.listed) / double(p.pairs.lit)) : json();
  out["memory_bytes"] = p.memory_bytes;
  out["bytes_moved"] = p.bytes_moved;
  out["nan_pixels"] = p.nan_pixels;
  out["front"] = p.front;
  out["tied_with"] = p.tied_with;
  return out;
}

json break_even_json(const BreakEven& b) {
  return {{"scene", b.scene},
          {"tighter", b.tighter},
          {"looser", b.looser},
          {"ns_per_pixel_light", finite_number(b.ns_per_pixel_light)},
          {"ci95", b.rounds > 0 ? pair_json(b.low, b.high) : json{nullptr, nullptr}},
          {"rounds", b.rounds},
          {"extra_ms", finite_number(b.extra_ms)},
          {"pairs_saved", finite_number(b.pairs_saved)}};
}

json cost_json(const ShadingCost& c) {
  return {{"scene", c.scene},
          {"technique", c.technique},
          {"brdf", c.brdf},
          {"ns_per_pixel_light", finite_number(c.ns_per_pixel_light)},
          {"ci95", pair_json(c.low, c.high)}};
}

json growth_json(const Growth& g) {
  return {{"scene", g.scene},
          {"technique", g.technique},
          {"of", g.of},
          {"exponent", finite_number(g.exponent)},
          {"ci95", pair_json(g.low, g.high)},
          {"samples", array_of(g.samples, [](const auto& s) { return pair_json(s.first, s.second); })}};
}

json failure_json(const Failure& f) {
  json out = finite_json(f.point);
  out["cause"] = f.cause;
  out["why"] = f.why;
  return out;
}

// A column of frontier.csv: its name, and where its value is in a row (as a JSON pointer).
struct Column {
  std::string name, pointer;
  bool of_refused = true;  // shown of records that were refused too
};

std::vector<Column> csv_columns() {
  std::vector<Column> all;
  for (const char* name :
       {"row",           "commit",      "seed",         "shard",     "cl",        "gl",       "scene",
        "label",         "technique",   "settings",     "frames",    "series",    "view",     "width",
        "height",        "lights",      "radius_scale", "refused",   "runs",      "frame_ms", "frame_ms_low",
        "frame_ms_high", "baseline_ms", "ratio",        "ratio_low", "ratio_high"})
    all.push_back({name, std::string("/") + name});
  for (const char* name : {"bytes_moved", "memory_bytes", "covered_pixels"})
    all.push_back({name, std::string("/") + name, false});
  for (const char* name : {"listed", "lit", "lost", "wrong"})
    all.push_back({name, std::string("/pairs/") + name, false});
  for (const char* name : {"nan_pixels", "overflow"}) all.push_back({name, std::string("/") + name, false});
  const auto add_measures = [&](const std::string& name, const std::string& pointer, bool of_refused) {
    for (const ErrorMeasure& m : frontier_error_measures())
      all.push_back({name + "_" + m.key, pointer + "/" + m.key, of_refused});
  };
  for (const auto& [key, ignored] : kinds_of_error) {
    const std::string kind = key;
    add_measures(kind, "/errors/" + kind, false);
    all.push_back({kind + "_flip_mean", "/errors/" + kind + "/flip_mean"});
  }
  for (const char* name : {"bias_rmse_rel", "deviation_rmse_rel", "temporal_rmse_rel"})
    all.push_back({name, std::string("/errors/") + name});
  all.push_back({"flip_start", "/flip_exposures/0"});
  all.push_back({"flip_stop", "/flip_exposures/1"});
  all.push_back({"flip_count", "/flip_exposures/2"});
  all.push_back({"image", "/image"});
  const std::string sampled = "/errors/in_double/";
  all.push_back({"in_double_pixels", sampled + "pixels"});
  add_measures("in_double", sampled + "picture", true);
  for (const auto& [of, kind] : {std::pair{"float_total", "picture_in_float"}, {"float_truth", "truth"}}) {
    for (const char* measure : {"max_rel", "rmse_rel"})
      all.push_back({fmt::format("in_double_{}_{}", of, measure), sampled + kind + "/" + measure});
  }
  return all;
}

// A record's fields as in its part, its times as medians with intervals, and the sweep's.
json csv_row(const FrontierAnswer& answer, size_t row) {
  const FrontierRecord& r = answer.part.records[row];
  json fields = ToJson{Numbers::finite}.json_of(r);
  fields.update(
      {{"row", row}, {"commit", answer.part.commit}, {"seed", answer.part.seed}, {"shard", r.shard}});
  for (const FrontierMachine& machine : answer.machines) {
    if (machine.shard == r.shard) fields.update({{"cl", machine.cl_device}, {"gl", machine.gl_device}});
  }
  std::vector<std::string> settings;
  for (const auto& [key, value] : r.point.settings) settings.push_back(key + "=" + value);
  fields["settings"] = fmt::format("{}", fmt::join(settings, " "));
  std::vector<double> ratios;
  for (size_t run = 0; run < r.frame_ms.size(); ++run) ratios.push_back(r.frame_ms[run] / r.baseline_ms[run]);
  const MedianInterval frame = median_interval(r.frame_ms);
  fields["runs"] = frame.runs;
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

std::string csv_field(const json& value) {
  if (value.is_string()) return value;
  if (value.is_number_float()) return figure(value);
  return value.is_null() ? "" : value.dump();
}

// Into `to`, what records name and is not there yet.
void collect_pictures(const fs::path& to, const FrontierAnswer& answer,
                      const std::vector<fs::path>& folders) {
  for (const FrontierRecord& record : answer.part.records) {
    if (record.image.empty()) continue;
    for (const char* suffix : picture_suffixes) {
      const std::string name = record.image + suffix;
      for (const fs::path& folder : folders) {
        std::error_code failure, ignored;
        if (fs::exists(to / name, failure) || !fs::exists(folder / name, failure)) continue;
        make_folder(to);
        if (fs::copy_file(folder / name, to / name, failure)) continue;
        fs::remove(to / name, ignored);  // half a picture would stay for good
        throw write_error(to / name, failure.value());
      }
    }
  }
}

}  // namespace

json to_json(const FrontierAnswer& answer) {
  const FrontierPart& part = answer.part;
  return {{"commit", part.commit},
          {"seed", part.seed},
          {"request", part.request},
          {"baseline", part.baseline},
          {"scenes", scenes_of(answer)},
          {"sentences", answer.sentences},
          {"machines", finite_json(answer.machines)},
          {"machine", finite_json(answer.machines.empty() ? part.machine : answer.machines.front())},
          {"points", array_of(answer.points, point_json)},
          {"best_within",
           array_of(answer.best_within,
                    [](const BestWithin& b) -> json {
                      return {{"scene", b.scene}, {"error", b.error}, {"point", b.point}, {"tied", b.tied}};
                    })},
          {"break_even", array_of(answer.break_even, break_even_json)},
          {"shading_costs", array_of(answer.shading_costs, cost_json)},
          {"growth", array_of(answer.growth, growth_json)},
          {"failures", array_of(answer.failures, failure_json)}};
}

std::string csv_text(const FrontierAnswer& answer) {
  const std::vector<Column> columns = csv_columns();
  std::vector<std::string> fields;
  for (const Column& column : columns) fields.push_back(column.name);
  std::string text = csv_line(fields);
  for (size_t row = 0; row < answer.part.records.size(); ++row) {
    const json values = csv_row(answer, row);
    const bool refused = !answer.part.records[row].refused.empty();
    fields.clear();
    for (const Column& column : columns) {
      const json::json_pointer at(column.pointer);
      const bool shown = (column.of_refused || !refused) && values.contains(at);
      fields.push_back(shown ? csv_field(values[at]) : "");
    }
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
    for (size_t run = 0; run < r.frame_ms.size(); ++run)
      text += fmt::format("{},{},{},{}\n", row, run, figure(r.frame_ms[run]), figure(r.baseline_ms[run]));
  }
  return text;
}

void write_answer(const fs::path& folder, const FrontierAnswer& answer, const std::vector<fs::path>& pictures,
                  size_t page_bytes) {
  collect_pictures(folder / "pictures", answer, pictures);
  write_file(folder / "frontier.json", json_text(to_json(answer)));
  write_file(folder / "frontier.csv", csv_text(answer));
  write_file(folder / "samples.csv", samples_csv_text(answer));
  write_file(folder / "culling.csv", cull_csv_text(answer));
  write_file(folder / "index.html", page_text(answer, folder / "pictures", page_bytes));
}

}  // namespace lightgrid
