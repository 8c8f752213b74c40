// frontier.json: docs/frontier_json.md.
#include <cmath>

#include "frontier/answer_steps.h"
#include "frontier/fields.h"
#include "measures/metrics.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

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
  out["views_ci95"] = t.has_interval() && t.over_views ? pair_json(t.over_views->low, t.over_views->high)
                                                       : json{nullptr, nullptr};
  return out;
}

// Wall-clock or processor time decides in a scene. Device time is always checked.
json control_json(const Control& c, bool decides = true) {
  return {{"scene", c.scene},
          {"relative_time", relative_time_json(c.relative_time)},
          {"places", finite_json(c.places)},
          {"half_width", finite_number(c.relative_time.half_width())},
          {"passed", c.passed()},
          {"widened_by", finite_number(std::exp(c.widening()))},
          {"decides", decides}};
}

json controls_json(const FrontierAnswer& answer, bool of_cpu) {
  return array_of(of_cpu ? answer.cpu_controls : answer.controls, [&](const Control& c) {
    return control_json(c, (clock_of_scene(answer, c.scene) == Clock::cpu) == of_cpu);
  });
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
          {"probability", finite_number(b.probability)},
          {"p_cheapest_views", finite_number(b.over_views)}};
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

// `half_width`: that the sweep was to reach.
json point_json(const PointFigures& p, double half_width) {
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
  out["cpu_ms"] = interval_json(p.cpu.cpu_ms);
  out["relative_cpu_time"] = relative_time_json(p.cpu.relative_time);
  out["clock"] = clock_names[size_t(p.decides)];
  out["half_width"] = finite_number(p.deciding_time().half_width());
  out["reached"] = p.deciding_time().half_width() <= half_width;
  for (const auto& [of, front] : p.deciding_fronts())
    out["p_front_views"][of] = finite_number(front.over_views);
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

}  // namespace

json to_json(const FrontierAnswer& answer) {
  const FrontierPart& part = answer.part;
  return {
      {"schema_version", frontier_schema_version},
      {"commit", part.commit},
      {"seed", part.seed},
      {"request", part.request},
      {"baseline", part.baseline},
      {"half_width", part.half_width},
      {"pixels_per_degree", default_pixels_per_degree},
      {"scenes", scenes_of(answer)},
      {"coverage", array_of(answer.coverage, coverage_json)},
      {"warnings", warnings_json(answer.part.warnings)},
      {"sentences", answer.sentences},
      {"machines", finite_json(answer.machines)},
      {"machine", finite_json(answer.machines.empty() ? part.machine : answer.machines.front())},
      {"points",
       array_of(answer.points, [&](const PointFigures& p) { return point_json(p, part.half_width); })},
      {"processes", array_of(answer.processes, process_json)},
      {"controls", controls_json(answer, false)},
      {"cpu_controls", controls_json(answer, true)},
      {"cheapest_within_flip", array_of(answer.cheapest_within, cheapest_json)},
      {"flip_front_bands", array_of(answer.front_bands, band_json)},
      {"device_controls", array_of(answer.device_controls, [](const Control& c) { return control_json(c); })},
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

}  // namespace lightgrid::lab
