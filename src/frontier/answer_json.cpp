// frontier.json: docs/frontier_json.md.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "frontier/answer.h"
#include "frontier/json_fields.h"
#include "frontier/record_file.h"

namespace lightgrid {
namespace {

using nlohmann::json;

json optional_finite(const std::optional<double>& value) { return value ? finite_number(*value) : json(); }

json interval_json(const MedianInterval& interval) {
  const bool timed = interval.runs > 0;
  const json low = timed ? finite_number(interval.low) : json(),
             high = timed ? finite_number(interval.high) : json();
  return {{"median", timed ? finite_number(interval.median) : json()},
          {"ci95", {low, high}},
          {"runs", interval.runs}};
}

json error_json(const ImageError& e) {
  return {{"max_rel", finite_number(e.max_rel)},
          {"rmse_rel", finite_number(e.rmse_rel)},
          {"relative_rmse", finite_number(e.relative_rmse)},
          {"p99_rel", finite_number(e.p99_rel)},
          {"flip_mean", optional_finite(e.flip_mean)}};
}

json in_double_json(const std::optional<SampledErrors>& sampled) {
  if (!sampled) return {};
  json figures = error_json(sampled->picture);
  figures.erase("flip_mean");
  figures["pixels"] = sampled->pixels;
  figures["float_total_max_rel"] = finite_number(sampled->picture_in_float.max_rel);
  figures["float_total_rmse_rel"] = finite_number(sampled->picture_in_float.rmse_rel);
  figures["float_truth_max_rel"] = finite_number(sampled->truth.max_rel);
  figures["float_truth_rmse_rel"] = finite_number(sampled->truth.rmse_rel);
  return figures;
}

json point_json(const FrontierPoint& point) {
  return {{"scene", point.scene},
          {"technique", point.technique},
          {"settings", settings_json(point.settings)},
          {"label", point.label},
          {"frames", point.frames}};
}

json point_json(const PointFigures& p) {
  json out = point_json(p.point);
  out["views"] = p.views;
  out["frame_ms"] = interval_json(p.frame_ms);
  out["ratio"] = interval_json(p.ratio);
  out["error"] = {{"model", error_json(p.errors.model)},
                  {"precision", error_json(p.errors.precision)},
                  {"technique", error_json(p.errors.technique)},
                  {"total", error_json(p.errors.total)},
                  {"in_double", in_double_json(p.errors.in_double)},
                  {"flip_views", p.flip_views},
                  {"temporal_views", p.temporal_views},
                  {"bias_rmse_rel", optional_finite(p.errors.bias_rmse_rel)},
                  {"deviation_rmse_rel", optional_finite(p.errors.deviation_rmse_rel)},
                  {"temporal_rmse_rel", optional_finite(p.errors.temporal_rmse_rel)}};
  out["pairs"] = {
      {"listed", p.pairs.listed}, {"lit", p.pairs.lit}, {"lost", p.pairs.lost}, {"wrong", p.pairs.wrong}};
  out["listed_per_lit"] = p.pairs.lit > 0 ? json(double(p.pairs.listed) / double(p.pairs.lit)) : json();
  out["memory_bytes"] = p.memory_bytes;
  out["bytes_moved"] = p.bytes_moved;
  out["nan_pixels"] = p.nan_pixels;
  out["front"] = p.front;
  out["tied_with"] = p.tied_with;
  return out;
}

bool is_same_point(const FrontierPoint& a, const FrontierPoint& b) {
  return a.scene == b.scene && a.label == b.label && a.frames == b.frames && a.technique == b.technique &&
         a.settings == b.settings;
}

json size_json(const FrontierPoint& point, const std::vector<FrontierRecord>& records) {
  const auto record = std::find_if(records.begin(), records.end(), [&](const FrontierRecord& r) {
    return r.series.empty() && is_same_point(r.point, point);
  });
  return record == records.end() ? json() : json{record->width, record->height};
}

std::vector<std::string> scenes_in_order(const std::vector<FrontierRecord>& records) {
  std::vector<std::string> scenes;
  for (const FrontierRecord& r : records) {
    if (std::find(scenes.begin(), scenes.end(), r.point.scene) == scenes.end())
      scenes.push_back(r.point.scene);
  }
  return scenes;
}

template <typename Items, typename Text>
json array_of(const Items& items, Text text) {
  json array = json::array();
  for (const auto& item : items) array.push_back(text(item));
  return array;
}

json growth_json(const Growth& g) {
  const json samples = array_of(g.samples, [](const auto& s) {
    return json{finite_number(s.first), finite_number(s.second)};
  });
  return {{"scene", g.scene},
          {"technique", g.technique},
          {"of", g.of},
          {"exponent", finite_number(g.exponent)},
          {"ci95", {finite_number(g.low), finite_number(g.high)}},
          {"samples", samples}};
}

}  // namespace

json to_json(const FrontierAnswer& answer) {
  const FrontierPart& part = answer.part;
  json out = {{"commit", part.commit},
              {"seed", part.seed},
              {"request", part.request},
              {"baseline", part.baseline},
              {"scenes", scenes_in_order(part.records)},
              {"sentences", answer.sentences}};
  out["machines"] = array_of(answer.machines, [](const FrontierMachine& m) { return to_json(m); });
  out["machine"] = answer.machines.empty() ? to_json(part.machine) : to_json(answer.machines.front());
  out["points"] = array_of(answer.points, [&](const PointFigures& p) {
    json point = point_json(p);
    point["size"] = size_json(p.point, part.records);
    return point;
  });
  out["best_within"] = array_of(answer.best_within, [](const BestWithin& b) -> json {
    return {{"scene", b.scene}, {"error", b.error}, {"point", b.point}, {"tied", b.tied}};
  });
  out["break_even"] = array_of(answer.break_even, [](const BreakEven& b) -> json {
    return {
        {"scene", b.scene},
        {"tighter", b.tighter},
        {"looser", b.looser},
        {"ns_per_pixel_light", finite_number(b.ns_per_pixel_light)},
        {"ci95", b.rounds > 0 ? json{finite_number(b.low), finite_number(b.high)} : json{nullptr, nullptr}},
        {"rounds", b.rounds},
        {"extra_ms", finite_number(b.extra_ms)},
        {"pairs_saved", finite_number(b.pairs_saved)}};
  });
  out["shading_costs"] = array_of(answer.shading_costs, [](const ShadingCost& c) -> json {
    return {{"scene", c.scene},
            {"technique", c.technique},
            {"brdf", c.brdf},
            {"ns_per_pixel_light", finite_number(c.ns_per_pixel_light)},
            {"ci95", {finite_number(c.low), finite_number(c.high)}}};
  });
  out["growth"] = array_of(answer.growth, growth_json);
  out["failures"] = array_of(answer.failures, [](const Failure& f) {
    json failure = point_json(f.point);
    failure["cause"] = f.cause;
    failure["why"] = f.why;
    return failure;
  });
  return out;
}

}  // namespace lightgrid
