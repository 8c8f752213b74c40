// The files of an answer: docs/frontier_json.md.
#include <algorithm>
#include <cmath>

#include "base/embedded.h"
#include "base/error.h"
#include "base/write_file.h"
#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "frontier/pictures.h"
#include "report/report.h"
#include "results/metrics.h"
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
  return {{"median", finite_number(i.median)},
          {"ci95", i.runs < min_rounds ? json{nullptr, nullptr} : pair_json(i.low, i.high)},
          {"runs", i.runs}};
}

json relative_time_json(const RelativeTime& t) {
  const bool timed = t.runs > 0;
  json out = {{"estimate", timed ? finite_number(t.estimate) : json()},
              {"ci95", t.has_interval() ? pair_json(t.low, t.high) : json{nullptr, nullptr}},
              {"runs", t.runs},
              {"processes", t.processes},
              {"between_processes", finite_json(t.between_processes)},
              {"modes", json::array()}};
  if (t.modes.size() == 2) out["modes"] = pair_json(t.modes[0], t.modes[1]);
  out["slow_share"] = t.modes.empty() ? json() : finite_number(t.slow_share);
  return out;
}

json control_json(const Control& c) {
  return {{"scene", c.scene},
          {"relative_time", relative_time_json(c.relative_time)},
          {"places", finite_json(c.places)},
          {"passed", c.passed()},
          {"widened_by", finite_number(std::exp(c.widening()))}};
}

json process_json(const ProcessConditions& p) {
  const auto range = [](const auto& r) { return r ? pair_json(r->first, r->second) : json(); };
  return {{"shard", p.shard},
          {"process", p.process},
          {"rounds", p.rounds},
          {"others_percent", finite_json(p.others_percent)},
          {"steal_percent", finite_json(p.steal_percent)},
          {"temperature_c", finite_json(p.temperature_c)},
          {"clock_mhz", range(p.clock_mhz)},
          {"power_w", range(p.power_w)},
          {"shared_rounds", p.shared_rounds},
          {"throttled_rounds", p.throttled_rounds}};
}

json cheapest_json(const CheapestWithin& b) {
  return {{"scene", b.scene},
          {"of", b.of},
          {"flip", b.error},
          {"point", b.point},
          {"relative_time", relative_time_json(b.relative_time)},
          {"probability", finite_number(b.probability)}};
}

json band_json(const FrontBand& b) {
  return {{"scene", b.scene},
          {"of", b.of},
          {"steps", array_of(b.steps, [](const BandStep& s) -> json {
             return {{"flip", finite_number(s.error)}, {"ci95", pair_json(s.low, s.high)}};
           })}};
}

// The picture's own figures, and some of the two others under their names.
json in_double_json(const SampledErrors& sampled) {
  json figures = finite_json(sampled.picture);
  for (const char* of_whole_pictures : {"flip_mean", "displayed_flip", "low_pass_rmse_of_mean"})
    figures.erase(of_whole_pictures);
  figures["pixels"] = sampled.pixels;
  for (const auto& [of, error] :
       {std::pair{"float_total_", sampled.picture_in_float}, {"float_truth_", sampled.truth}}) {
    figures[std::string(of) + "max_rel"] = finite_number(error.max_rel);
    figures[std::string(of) + "rmse_rel"] = finite_number(error.rmse_rel);
  }
  return figures;
}

// Student's t, seven degrees of freedom a view: a view's pictures are in eight groups.
json seeds_json(const PointFigures& p) {
  const SeedErrors& seeds = *p.errors.seeds;
  const double reach =
      student_t_quantile(0.975, (BiasOfPictures::groups - 1) * p.views) * seeds.bias_mse_rel_error;
  const auto root = [](double square) { return std::sqrt(std::max(square, 0.0)); };
  return {
      {"pictures", seeds.pictures},
      {"flip_pictures", seeds.flip_pictures},
      {"deviation", finite_json(seeds.deviation)},
      {"bias_rmse_rel_ci95", pair_json(root(seeds.bias_mse_rel - reach), root(seeds.bias_mse_rel + reach))}};
}

json on_front_json(const OnFront& front) {
  return {{"on", front.on}, {"probability", finite_number(front.probability)}};
}

void add_device_json(const DeviceFigures& d, json& out) {
  out["device_ms"] = interval_json(d.device_ms);
  out["hand_over_ms"] = interval_json(d.hand_over_ms);
  out["copy_ms"] = interval_json(d.copy_ms);
  out["read_back_ms"] = interval_json(d.read_back_ms);
  out["relative_device_time"] = relative_time_json(d.relative_time);
  for (const auto& [of, front] : d.fronts) out["device_fronts"][of] = on_front_json(front);
}

json point_json(const PointFigures& p) {
  json out = finite_json(p.point);
  out["views"] = p.views;
  out["timed_views"] = p.timed_views;
  out["exposure_ev"] = finite_json(p.exposure_ev);
  out["size"] = p.width > 0 ? json{p.width, p.height} : json();
  out["frame_ms"] = interval_json(p.frame_ms);
  out["frame_ms_within"] = p.frame_ms.runs >= min_rounds
                               ? json{{"p95", finite_number(p.p95_ms)}, {"p99", finite_number(p.p99_ms)}}
                               : json{{"p95", nullptr}, {"p99", nullptr}};
  out["relative_time"] = relative_time_json(p.relative_time);
  json& error = out["error"] = finite_json(p.errors);
  error["in_double"] = p.errors.in_double ? in_double_json(*p.errors.in_double) : json();
  if (!p.errors.authored) error.erase("authored");
  error.erase("seeds");
  if (p.errors.seeds) error["seeds"] = seeds_json(p);
  for (const auto& [of, interval] : p.over_views)
    error["over_views_ci95"][of.first][of.second] = pair_json(interval.first, interval.second);
  error["flip_views"] = p.flip_views;
  error["temporal_views"] = p.temporal_views;
  if (p.external) out["external"] = finite_json(*p.external);
  out["pairs"] = p.external ? json() : pairs_json(p.pairs);
  if (p.pairs.shadows) {
    out["leaked_percent"] = finite_json(leaked_percent(p.pairs));
    out["acned_percent"] = finite_json(acned_percent(p.pairs));
  }
  if (p.truth) out["truth"] = finite_json(*p.truth);
  out["listed_per_lit"] = p.pairs.lit > 0 ? json(double(p.pairs.listed) / double(p.pairs.lit)) : json();
  out["memory_bytes"] = p.external ? json() : json(p.memory_bytes);
  out["bytes_moved"] = p.external ? json() : json(p.bytes_moved);
  out["passes"] = json::object();
  for (const auto& [pass, ms] : p.pass_ms) {
    const auto bytes = p.pass_bytes.find(pass);
    out["passes"][pass] = {{"ms", finite_number(ms)},
                           {"bytes", bytes == p.pass_bytes.end() ? json() : json(bytes->second)}};
  }
  out["nan_pixels"] = p.nan_pixels;
  for (const auto& [of, front] : p.fronts) out["fronts"][of] = on_front_json(front);
  add_device_json(p.device, out);
  return out;
}

json among_json(const AmongOpenCl& a) {
  return {{"scene", a.scene},
          {"point", a.point},
          {"over", a.over},
          {"relative_time", relative_time_json(a.relative_time)},
          {"relative_device_time", relative_time_json(a.relative_device_time)}};
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
          {"kept", g.kept.empty() ? json() : json(g.kept)},
          {"exponent", finite_number(g.exponent)},
          {"ci95", pair_json(g.low, g.high)},
          {"samples", array_of(g.samples, [](const auto& s) { return pair_json(s.first, s.second); })}};
}

json equal_flip_json(const EqualFlip& e) {
  return {{"scene", e.scene},
          {"technique", e.technique},
          {"series", e.series},
          {"of", e.of},
          {"flip", e.error},
          {"exponent", finite_number(e.exponent)},
          {"ci95", pair_json(e.low, e.high)},
          {"samples", array_of(e.samples, [](const EqualFlip::Sample& s) -> json {
             return {{"x", s.x}, {"ms", finite_number(s.ms)}, {"label", s.label}};
           })}};
}

json coverage_json(const Coverage& c) {
  return {{"scene", c.scene}, {"points_measured", c.measured}, {"points_asked", c.asked}};
}

json failure_json(const Failure& f) {
  json out = finite_json(f.point);
  out["cause"] = f.cause;
  out["why"] = f.why;
  return out;
}

std::vector<CsvColumn> csv_columns(bool truths, bool external, bool shadows, bool authored, bool seeds,
                                   bool sequences, bool surfaces, bool families) {
  std::vector<CsvColumn> all;
  const auto add_measures = [&](const std::string& within, const std::string& prefix) {
    for (const ErrorMeasure& m : frontier_error_measures()) add_columns(all, {m.key}, within, prefix);
  };
  add_columns(all, {"row",       "commit",    "seed",         "shard",         "cl",           "gl",
                    "scene",     "label",     "technique",    "settings",      "frames",       "series",
                    "view",      "width",     "height",       "lights",        "radius_scale", "refused",
                    "runs",      "frame_ms",  "frame_ms_low", "frame_ms_high", "baseline_ms",  "ratio",
                    "ratio_low", "ratio_high"});
  add_columns(all, {"device_ms", "hand_over_ms", "copy_ms", "read_back_ms", "baseline_device_ms"});
  add_columns(all, {"bytes_moved", "memory_bytes", "covered_pixels"});
  add_columns(all, {"listed", "lit", "lost", "wrong"}, "/pairs");
  add_columns(all, {"nan_pixels", "overflow"});
  for (const auto& [key, ignored] : kinds_of_error) {
    const std::string kind = key;
    add_measures("/errors/" + kind, kind + "_");
    add_columns(all, {"flip_mean"}, "/errors/" + kind, kind + "_");
    if (kind != "model" && kind != "total") continue;
    add_columns(all, {"mean", "visible_share"}, "/errors/" + kind + "/displayed_flip",
                kind + "_displayed_flip_");
  }
  for (const std::string kind : {"model", "total"}) {
    if (!authored) break;
    const std::string within = "/errors/authored/" + kind, prefix = "authored_" + kind + "_";
    add_measures(within, prefix);
    add_columns(all, {"mean", "visible_share"}, within + "/displayed_flip", prefix + "displayed_flip_");
  }
  add_columns(all, {"bias_rmse_rel", "deviation_rmse_rel", "temporal_rmse_rel"}, "/errors");
  if (seeds) {
    add_columns(all, {"pictures", "flip_pictures", "bias_mse_rel", "bias_mse_rel_error"}, "/errors/seeds",
                "seeds_");
    add_measures("/errors/seeds/deviation", "seeds_deviation_");
    all.push_back({"seeds_deviation_displayed_flip_mean", "/errors/seeds/deviation/displayed_flip/mean"});
  }
  for (const auto& [key, ignored] : sequences_of_errors) {
    for (const std::string kind : {"plain", "filtered"}) {
      if (!sequences) break;
      const std::string within = std::string("/errors/sequences/") + key + "/" + kind,
                        prefix = std::string(key) + "_" + kind + "_";
      add_columns(all, {"mean", "visible_share"}, within + "/flicker", prefix + "flicker_");
      add_columns(all, {"largest_flicker"}, within, prefix);
      add_columns(all, {"mean", "visible_share"}, within + "/displayed_flip", prefix + "displayed_flip_");
    }
  }
  if (surfaces) {
    add_measures("/errors/surfaces", "surfaces_");
    add_columns(all, {"mean", "visible_share"}, "/errors/surfaces/displayed_flip",
                "surfaces_displayed_flip_");
  }
  for (const auto& [name, index] : {std::pair{"flip_start", "0"}, {"flip_stop", "1"}, {"flip_count", "2"}})
    all.push_back({name, std::string("/flip_exposures/") + index});
  add_columns(all, {"exposure_ev", "image"});
  const std::string sampled = "/errors/in_double";
  add_columns(all, {"pixels"}, sampled, "in_double_");
  add_measures(sampled + "/picture", "in_double_");
  add_columns(all, {"max_rel", "rmse_rel"}, sampled + "/picture_in_float", "in_double_float_total_");
  add_columns(all, {"max_rel", "rmse_rel"}, sampled + "/truth", "in_double_float_truth_");
  if (families) add_columns(all, {"overlap", "pair_pixels"});
  if (truths) add_columns(all, {"own_ranges", "shadow_source", "shadow_rays", "places"}, "/truth", "truth_");
  if (external) add_columns(all, {"note", "paired"}, "/external", "external_");
  if (!shadows) return all;
  add_columns(all, {"leaked", "acned", "either"}, "/pairs/shadows");
  add_columns(all, {"pixels", "pairs"}, "/pairs/shadows", "shadow_");
  add_columns(all, {"leaked_percent", "acned_percent"});
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
  fields["settings"] = settings_field(r.point.settings);
  if (r.pairs.shadows) {
    fields["leaked_percent"] = finite_json(leaked_percent(r.pairs));
    fields["acned_percent"] = finite_json(acned_percent(r.pairs));
  }
  if (!r.refused.empty() || r.external) {
    for (const char* key : {"bytes_moved", "memory_bytes", "covered_pixels", "pairs", "overflow"})
      fields.erase(key);
  }
  if (!r.refused.empty()) {  // what it would have drawn
    fields.erase("nan_pixels");
    for (const auto& [kind, ignored] : kinds_of_error) fields["errors"].erase(kind);
  }
  std::vector<double> ratios;
  for (size_t run = 0; run < r.frame_ms.size(); ++run) ratios.push_back(r.frame_ms[run] / r.baseline_ms[run]);
  const MedianInterval frame = median_interval(r.frame_ms);
  fields["runs"] = frame.runs;
  for (const auto& [key, times] : times_by_device)
    fields[key] = (r.*times).empty() ? json() : finite_number(median_interval(r.*times).median);
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

// The first picture that a record of the point names.
std::string picture_of(const FrontierAnswer& answer, const FrontierPoint& point) {
  const std::string key = point_key(point);
  for (const FrontierRecord& r : answer.part.records) {
    if (!r.image.empty() && r.series.empty() && point_key(r.point) == key) return r.image;
  }
  return "";
}

// frontier.json, with the pictures of each point and what the page says of each scene.
json page_data_of(const FrontierAnswer& answer, const PagePictures& pictures) {
  json data = to_json(answer);
  data["pictures"] = pictures.urls;
  data["reduced"] = pictures.reduced;
  for (size_t i = 0; i < answer.points.size(); ++i) {
    const auto found = pictures.by_name.find(picture_of(answer, answer.points[i].point));
    data["points"][i]["pictures"] = found == pictures.by_name.end() ? json() : json(found->second);
  }
  data["scenes"] = json::array();
  for (const std::string& scene : scenes_of(answer)) {
    const SceneWords words = words_of_scene(answer, scene);
    data["scenes"].push_back({{"key", scene},
                              {"title", scene_in_words(scene)},
                              {"opening", words.opening},
                              {"notes", words.notes}});
  }
  data["default_time"] = answer.by_device ? "relative_device" : "relative";
  // In the order of their colors.
  data["techniques"] =
      distinct(answer.part.records, [](const FrontierRecord& r) { return r.point.technique; });
  data["measures"].push_back({{"key", "displayed_flip"}, {"title", "FLIP as displayed"}});
  for (const ErrorMeasure& measure : frontier_error_measures())
    data["measures"].push_back({{"key", measure.key}, {"title", measure.frontier_title}});
  data["measures"].push_back({{"key", "flip_mean"}, {"title", "HDR-FLIP"}});
  return data;
}

}  // namespace

json to_json(const FrontierAnswer& answer) {
  const FrontierPart& part = answer.part;
  return {{"schema_version", frontier_schema_version},
          {"commit", part.commit},
          {"seed", part.seed},
          {"request", part.request},
          {"baseline", part.baseline},
          {"pixels_per_degree", default_pixels_per_degree},
          {"scenes", scenes_of(answer)},
          {"coverage", array_of(answer.coverage, coverage_json)},
          {"warnings", warnings_json(answer.part.warnings)},
          {"sentences", answer.sentences},
          {"machines", finite_json(answer.machines)},
          {"machine", finite_json(answer.machines.empty() ? part.machine : answer.machines.front())},
          {"points", array_of(answer.points, point_json)},
          {"processes", array_of(answer.processes, process_json)},
          {"controls", array_of(answer.controls, control_json)},
          {"cheapest_within_flip", array_of(answer.cheapest_within, cheapest_json)},
          {"flip_front_bands", array_of(answer.front_bands, band_json)},
          {"device_controls", array_of(answer.device_controls, control_json)},
          {"device_cheapest_within_flip", array_of(answer.device_cheapest_within, cheapest_json)},
          {"device_flip_front_bands", array_of(answer.device_front_bands, band_json)},
          {"among_opencl", array_of(answer.among_opencl, among_json)},
          {"break_even", array_of(answer.break_even, break_even_json)},
          {"shading_costs", array_of(answer.shading_costs, cost_json)},
          {"growth", array_of(answer.growth, growth_json)},
          {"equal_flip", array_of(answer.equal_flip, equal_flip_json)},
          {"device_equal_flip", array_of(answer.device_equal_flip, equal_flip_json)},
          {"failures", array_of(answer.failures, failure_json)}};
}

std::string csv_text(const FrontierAnswer& answer) {
  std::vector<json> rows;
  for (size_t row = 0; row < answer.part.records.size(); ++row) rows.push_back(csv_row(answer, row));
  const auto any = [&](const auto& has) { return std::ranges::any_of(answer.part.records, has); };
  const bool truths = any([](const FrontierRecord& r) { return r.truth.has_value(); });
  const bool external = any([](const FrontierRecord& r) { return r.external.has_value(); });
  const bool shadows = any([](const FrontierRecord& r) { return r.pairs.shadows.has_value(); });
  const bool authored = any([](const FrontierRecord& r) { return r.errors.authored.has_value(); });
  const bool seeds = any([](const FrontierRecord& r) { return r.errors.seeds.has_value(); });
  const bool sequences = any([](const FrontierRecord& r) { return r.errors.sequences.has_value(); });
  const bool surfaces = any([](const FrontierRecord& r) { return r.errors.surfaces.has_value(); });
  return csv_table(
      csv_columns(truths, external, shadows, authored, seeds, sequences, surfaces, any(is_of_family)), rows);
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
  std::string text = "row,run,process,frame_ms,baseline_ms,device_ms,baseline_device_ms\n";
  const auto of = [](const std::vector<double>& times, size_t run) {
    return run < times.size() ? figure(times[run]) : "";
  };
  for (size_t row = 0; row < answer.part.records.size(); ++row) {
    const FrontierRecord& r = answer.part.records[row];
    for (size_t run = 0; run < r.frame_ms.size(); ++run)
      text += fmt::format("{},{},{},{},{},{},{}\n", row, run, run < r.processes.size() ? r.processes[run] : 0,
                          figure(r.frame_ms[run]), figure(r.baseline_ms[run]), of(r.device_ms, run),
                          of(r.baseline_device_ms, run));
  }
  return text;
}

std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures,
                      size_t most_picture_bytes) {
  std::vector<std::string> names;
  if (!pictures.empty()) {
    for (const FrontierRecord& r : answer.part.records) names.push_back(r.image);
  }
  std::string style = embedded_file("report/page/style.css"), script;
  style += embedded_file("frontier/page/frontier.css");
  for (const char* name : {"report/page/elements.js", "report/page/table.js", "report/page/plot.js",
                           "report/page/bars.js", "frontier/page/figures.js", "frontier/page/front.js",
                           "frontier/page/costs.js", "frontier/page/frontier.js"}) {
    script += embedded_file(name);
  }
  const json data = page_data_of(answer, page_pictures(pictures, names, most_picture_bytes));
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  return filled(embedded_file("frontier/page/index.html"),
                {{"style", style}, {"script", script}, {"page", script_json(text)}});
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
