#include "measures/results.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_file.h"
#include "base/text.h"
#include "measures/error_measures.h"
#include "measures/path_changes.h"
#include "measures/relative_frames.h"
#include "measures/speedup.h"
#include "plan/settings.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

json value_of(const std::string& setting) {
  if (setting == "true" || setting == "false") return setting == "true";
  if (const auto whole = parse_number<int64_t>(setting)) return *whole;
  if (const auto real = parse_number<double>(setting); real && std::isfinite(*real)) return *real;
  return setting;
}

json to_json(const std::optional<SurfacesError>& error) {
  if (!error) return {};
  return {{"pixels", error->pixels},
          {"sum_rel", finite_number(error->sum_rel)},
          {"max_rel", finite_number(error->max_rel)},
          {"rmse_rel", finite_number(error->rmse_rel)},
          {"p99_rel", finite_number(error->p99_rel)}};
}

json to_json(const AreaError::Part& part) {
  return {{"pixels", part.pixels},
          {"max_rel", finite_number(part.max_rel)},
          {"rmse_rel", finite_number(part.rmse_rel)},
          {"rmse_shown", finite_number(part.rmse_shown)}};
}

json to_json(const std::optional<DisplayedFlip>& flip) {
  if (!flip) return {};
  return {{"mean", flip->mean}, {"visible_share", flip->visible}, {"visible_from", visible_flip}};
}

json measures_json(const ImageError& error) {
  json values = {{"bit_identical", error.bit_identical}, {"displayed_flip", to_json(error.displayed)}};
  for (const ErrorMeasure& measure : error_measures())
    values[measure.key] = finite_number(error.*measure.value);
  return values;
}

json same_surfaces_json(const RunResult& row) {
  const ImageError* error = light_error(row);
  if (!error) return {};
  json values = measures_json(*error);
  values["reference"] = every_light_on(row.own_surfaces);
  return values;
}

json to_json(const ImageError& error) {
  json oracle;
  if (error.oracle) {
    oracle = {{"max_rel", finite_number(error.oracle->max_rel)},
              {"rmse_rel", finite_number(error.oracle->rmse_rel)},
              {"of_reference_max_rel", finite_number(error.oracle->of_reference_max_rel)}};
  }
  json silhouettes, inside;
  if (const auto& apart = error.silhouettes) {
    const double pixels = double(apart->silhouettes + apart->blended + apart->inside);
    silhouettes = {{"pixels", apart->silhouettes},
                   {"share", pixels > 0 ? double(apart->silhouettes) / pixels : 0}};
    inside = {{"pixels", apart->inside},
              {"max_rel", finite_number(apart->max_rel)},
              {"rmse_rel", finite_number(apart->rmse_rel)},
              {"p99_rel", finite_number(apart->p99_rel)}};
  }
  json values = measures_json(error);
  values.update({{"flip_mean", error.flip_mean ? finite_number(*error.flip_mean) : json()},
                 {"oracle", oracle},
                 {"silhouettes", silhouettes},
                 {"inside", inside},
                 {"surfaces", to_json(error.surfaces)}});
  if (error.area)
    values["area"] = {{"edges", to_json(error.area->edges)}, {"inside", to_json(error.area->inside)}};
  return values;
}

json to_json(const Spread& times) {
  const bool timed = times.runs > 0;
  return {{"min", timed ? finite_number(times.min) : json()},
          {"median", timed ? finite_number(times.median) : json()},
          {"max", timed ? finite_number(times.max) : json()},
          {"runs", times.runs}};
}

json speedup_json(const CompareReport& report, const RunResult& row) {
  const std::optional<Speedup> speedup = speedup_of(report, row);
  if (!speedup) return {};
  const auto factor = [](const std::optional<double>& f) { return f ? finite_number(*f) : json(); };
  const bool by_row = speedup->by && speedup->by >= report.rows.data() &&
                      speedup->by < report.rows.data() + report.rows.size();
  return {{"total", finite_number(speedup->total)},
          {"lists", factor(speedup->lists)},
          {"api", factor(speedup->api)},
          {"other", finite_number(speedup->other)},
          {"lists_in_opencl", factor(speedup->lists_in_opencl)},
          {"by", !speedup->by ? json()
                 : by_row     ? json(speedup->by->technique)
                              : json(every_light_on(true))}};
}

json to_json(const std::optional<OwnSurfaces>& own) {
  if (!own) return {};
  return {{"technique", every_light_on(true)},
          {"error", own->error ? to_json(*own->error) : json()},
          {"why_not", own->why_not.empty() ? json() : json(own->why_not)},
          {"frame_ms", own->every_light ? to_json(own->every_light->frame_ms) : json()}};
}

json memory_json(const RunResult& result) {
  const auto bytes = [&](size_t count) { return result.refused.empty() ? json(count) : json(); };
  return {{"total", bytes(result.memory_total)},
          {"light_grid", bytes(result.memory_light_grid)},
          {"gbuffer", bytes(result.memory_gbuffer)}};
}

json to_json(const PassResult& pass) {
  json kernels = json::array();
  for (const KernelResult& kernel : pass.kernels) {
    kernels.push_back({{"name", kernel.name}, {"median_ms", finite_number(kernel.median_ms)}});
  }
  return {{"name", pass.name},
          {"on", pass.on},
          {"median_ms", finite_number(pass.median_ms)},
          {"bytes_read", pass.bytes_read},
          {"bytes_written", pass.bytes_written},
          {"kernels", std::move(kernels)}};
}

json to_json(const MovingResult& m) {
  return {
      {"frames", m.frames},
      {"frame_ms", to_json(m.frame_ms)},
      {"resting_ms", to_json(m.resting_ms)},
      {"over_resting", to_json(m.over_resting)},
      {"error",
       {{"max_abs", finite_number(m.max_abs)},
        {"max_rel", finite_number(m.max_rel)},
        {"rmse_rel", finite_number(m.rmse_rel)}}},
      {"temporal",
       {{"max_rel", finite_number(m.temporal_max_rel)}, {"rmse_rel", finite_number(m.temporal_rmse_rel)}}},
      {"pairs", pairs_json(m.pairs)},
      {"nan_pixels", m.nan_pixels},
      {"gl_programs_compiled", m.gl_programs},
      {"cl_programs_built", m.cl_programs},
      {"scene_bytes_uploaded", m.scene_bytes}};
}

json to_json(const ShadowResult& s) {
  json skipped = json::array();
  for (const auto& light : s.skipped) skipped.push_back({{"light", light.light}, {"why", light.why}});
  json out = {{"lights", s.lights}, {"maps", s.maps}, {"drawn", s.drawn},         {"kept", s.kept},
              {"bytes", s.bytes},   {"rays", s.rays}, {"undecided", s.undecided}, {"skipped", skipped}};
  if (s.dim_steps > 0) out["dim_steps"] = s.dim_steps;
  if (s.bands > 1) out["bands"] = s.bands;
  if (s.maps > 0) out["halvings"] = s.halvings;
  if (s.tiles_kept > 0) out["tiles_kept"] = s.tiles_kept;
  return out;
}

}  // namespace

json warnings_json(const std::vector<Warning>& warnings) {
  json list = json::array();
  for (const Warning& w : warnings)
    list.push_back({{"text", w.text},
                    {"settings", w.settings},
                    {"command", w.command.empty() ? json() : json(w.command)}});
  return list;
}

json pairs_json(const PairCounts& pairs) {
  json all = {{"listed", pairs.listed}, {"lit", pairs.lit}, {"lost", pairs.lost}, {"wrong", pairs.wrong}};
  if (const auto& shadows = pairs.shadows)
    all.update({{"leaked", shadows->leaked},
                {"acned", shadows->acned},
                {"either", shadows->either},
                {"shadow_pixels", shadows->pixels},
                {"shadow_pairs", shadows->pairs}});
  if (const auto& blended = pairs.blended)
    all["blended"] = {{"lit", blended->lit},
                      {"leaked", blended->leaked},
                      {"acned", blended->acned},
                      {"either", blended->either}};
  return all;
}

ShadowPairs& ShadowPairs::operator+=(const ShadowPairs& other) {
  leaked += other.leaked;
  acned += other.acned;
  either += other.either;
  pixels += other.pixels;
  pairs += other.pairs;
  says_exact = says_exact && other.says_exact;
  return *this;
}

PairCounts& PairCounts::operator+=(const PairCounts& other) {
  listed += other.listed;
  lit += other.lit;
  lost += other.lost;
  wrong += other.wrong;
  if (other.shadows && shadows) *shadows += *other.shadows;
  if (!shadows) shadows = other.shadows;
  return *this;
}

const char* every_light_on(bool own_surfaces) { return own_surfaces ? "visibility:lights=all" : "forward"; }

const ImageError* light_error(const RunResult& row) {
  if (row.same_surfaces) return &*row.same_surfaces;
  return row.error && !row.own_surfaces ? &*row.error : nullptr;
}

json exposure_json(const Exposure& exposure) { return {{"ev", exposure.ev}, {"auto", exposure.automatic}}; }

json settings_json(const std::map<std::string, std::string>& settings) {
  json out = json::object();
  for (const auto& [name, value] : settings) out[json_key(name)] = value_of(value);
  return out;
}

// A pass whose result serves many frames is not in the frame's median; its share is added here.
static json build_json(const PassResult& pass, const RunResult& result) {
  json build = {{"pass", pass.name}, {"median_ms", pass.median_ms}};
  for (const auto& [key, value] : result.built_with) build[key] = value;
  for (const int frames : {1, 10, 100})
    build["frame_ms_over"][std::to_string(frames)] = result.frame_ms.median + pass.median_ms / frames;
  return build;
}

json to_json(const RunResult& result) {
  json passes = json::array(), skipped = json::array();
  for (const auto& pass : result.passes) passes.push_back(to_json(pass));
  for (const auto& skip : result.skipped) skipped.push_back({{"effect", skip.effect}, {"why", skip.why}});
  json out = {{"technique", result.technique},
              {"settings", settings_json(result.settings)},
              {"lights", {{"total", result.lights_total}, {"in_view", result.lights_in_view}}},
              {"frame_ms", to_json(result.frame_ms)},
              {"frame_cpu_ms", to_json(spread_of(result.cpu_ms))},
              {"passes", passes},
              {"memory_bytes", memory_json(result)},
              {"pairs", result.pairs ? pairs_json(*result.pairs) : json()},
              {"error", result.error ? to_json(*result.error) : json()},
              {"same_surfaces", same_surfaces_json(result)},
              {"unshaded", result.unshaded ? json(*result.unshaded) : json()},
              {"nan_pixels", result.nan_pixels},
              {"inf_pixels", result.inf_pixels},
              {"overflow", result.overflow},
              {"skipped", skipped}};
  if (result.lights_virtual > 0) out["lights"]["virtual"] = result.lights_virtual;
  for (const auto& pass : result.passes) {
    if (pass.name == result.built_by) out["build"] = build_json(pass, result);
  }
  if (const auto& l = result.limited)
    out["limited"] = {{"lost_light", l->lost_light},
                      {"step_at_borders", l->steps.at_borders},
                      {"step_inside", l->steps.inside}};
  if (result.shadows) out["shadows"] = to_json(*result.shadows);
  if (const auto& s = result.samples) {
    out["samples"] = {{"edge_pixels", s->edge_pixels},
                      {"shadings", s->shadings},
                      {"covered", s->covered},
                      {"bytes", s->bytes}};
  }
  if (!result.effects.empty()) out["effects"] = result.effects;
  if (result.moving) out["moving"] = to_json(*result.moving);
  if (!result.refused.empty()) out["refused"] = result.refused;
  return out;
}

const RunResult* reference_row(const CompareReport& report) {
  const size_t colon = report.reference.find(':'), equals = report.reference.find('=');
  const auto is_reference = [&](const RunResult& row) {
    if (row.technique != report.reference.substr(0, colon)) return false;
    const auto shadows = row.settings.find("shadows");
    if (shadows != row.settings.end() && shadows->second != "exact") return false;
    if (colon == std::string::npos) return true;
    const auto setting = row.settings.find(report.reference.substr(colon + 1, equals - colon - 1));
    return setting != row.settings.end() && setting->second == report.reference.substr(equals + 1);
  };
  const RunResult* refused = nullptr;
  for (const RunResult& row : report.rows) {
    if (!is_reference(row)) continue;
    if (row.refused.empty()) return &row;
    if (!refused) refused = &row;
  }
  return refused;
}

const Image& reference_image(const CompareReport& report) {
  const RunResult* row = reference_row(report);
  const size_t i = row ? size_t(row - report.rows.data()) : report.images.size();
  return i < report.images.size() && !report.images[i].pixels.empty() ? report.images[i]
                                                                      : report.reference_image;
}

const Image& image_of(const CompareReport& report, size_t row) {
  static const Image none;
  if (row >= report.images.size()) return none;
  const Image& own = report.images[row];
  if (!own.pixels.empty() || row >= report.rows.size()) return own;
  const std::optional<ImageError>& error = report.rows[row].error;
  return error && error->bit_identical ? reference_image(report) : own;
}

// Relative to the reference, where that is another row: by both clocks, and the one that decides.
static void add_relative_times(const CompareReport& report, const RunResult& row, json& out) {
  const RunResult* reference = reference_row(report);
  if (!reference || reference == &row) return;
  const FrameTimes own = times_of(row), others = times_of(*reference);
  out["relative_time"] = to_json(relative_wall_time(own, others));
  out["relative_cpu_time"] = to_json(relative_cpu_time(own, others));
  out["clock"] = relative_frames(own, others).by_cpu ? "cpu" : "wall";
}

json to_json(const CompareReport& report) {
  json rows = json::array(), reference_errors;
  for (const auto& row : report.rows) {
    rows.push_back(to_json(row));
    rows.back()["speedup"] = speedup_json(report, row);
    add_relative_times(report, row, rows.back());
  }
  if (const auto& errors = report.reference_errors) {
    reference_errors = {{"model", to_json(errors->model)},
                        {"precision", to_json(errors->precision)},
                        {"pixels_left_out", errors->pixels_left_out}};
  }
  json out = {{"scene", report.scene},
              {"size", {report.width, report.height}},
              {"ambient", {report.ambient.r, report.ambient.g, report.ambient.b}},
              {"exposure", exposure_json(report.exposure)},
              {"devices", {{"cl", report.cl_device}, {"gl", report.gl_device}}},
              {"commit", report.commit},
              {"warnings", warnings_json(report.warnings)},
              {"reference",
               {{"technique", report.reference},
                {"pixels", report.reference_pixels},
                {"brightest", finite_number(report.brightest)},
                {"surfaces", to_json(report.reference_surfaces)}}},
              {"reference_errors", reference_errors},
              {"own_surfaces", to_json(report.own_surfaces)},
              {"covered_pixels", report.covered_pixels ? json(report.covered_pixels) : json()},
              {"rows", rows}};
  if (!report.lights_kept.empty()) {
    out["lights_kept"] = report.lights_kept;
    out["ranges_of"] = report.ranges_of > 0 ? json(report.ranges_of) : json();
  }
  if (const auto& memory = report.path_memory) {
    out["moving"] = {
        {"resident_bytes",
         {{"frames", memory->frames}, {"then", memory->bytes}, {"at_end", memory->bytes_at_end}}},
        {"plan_changes", plan_changes_json(report)}};
  }
  return out;
}

std::string json_text(const CompareReport& report) { return json_text(to_json(report)); }

std::string json_text(const RunResult& result) { return json_text(to_json(result)); }

std::string json_text(const json& value) {
  return value.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace lightgrid::lab
