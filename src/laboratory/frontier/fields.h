// The fields of what a frontier measures, each named once: its key, its member and what a reader demands of
// it. Parts, the keys of records, frontier.json and frontier.csv are made by visiting them
// (docs/frontier_json.md).
#pragma once

#include <cmath>
#include <concepts>
#include <nlohmann/json.hpp>

#include "base/json_file.h"
#include "frontier/record.h"
#include "measures/error_measures.h"

namespace lightgrid::lab {

// The demands of a reader: whole numbers are at least `low`, and a field that is not required keeps its
// value. One that is not required and absent is not written.
struct FieldRule {
  int low = 0;
  bool required = true;
};

template <typename T, typename U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <Is<FrontierPoint> T, typename Visit>
void visit_fields(T& p, Visit&& visit) {
  visit("scene", p.scene);
  visit("technique", p.technique);
  visit("settings", p.settings);
  visit("label", p.label);
  visit("frames", p.frames, FieldRule{.low = 1});
}

template <Is<ShadowPairs> T, typename Visit>
void visit_fields(T& s, Visit&& visit) {
  visit("leaked", s.leaked);
  visit("acned", s.acned);
  visit("either", s.either);
  visit("pixels", s.pixels);
  visit("pairs", s.pairs);
  visit("says_exact", s.says_exact);
}

template <Is<PairCounts> T, typename Visit>
void visit_fields(T& p, Visit&& visit) {
  visit("listed", p.listed);
  visit("lit", p.lit);
  visit("lost", p.lost);
  visit("wrong", p.wrong);
  visit("shadows", p.shadows, FieldRule{.required = false});
}

template <Is<FrontierTruth> T, typename Visit>
void visit_fields(T& t, Visit&& visit) {
  visit("own_ranges", t.own_ranges);
  visit("shadow_source", t.source_m);
  visit("shadow_rays", t.shadow_rays, FieldRule{.low = 1});
  visit("places", t.places, FieldRule{.low = 1, .required = false});
}

template <Is<ExternalPoint> T, typename Visit>
void visit_fields(T& e, Visit&& visit) {
  visit("note", e.note);
  visit("paired", e.paired);
}

template <Is<DisplayedFlip> T, typename Visit>
void visit_fields(T& f, Visit&& visit) {
  visit("mean", f.mean);
  visit("visible_share", f.visible);
}

// Parts of earlier versions lack the measures that are unknown unless something is read.
template <Is<ImageError> T, typename Visit>
void visit_fields(T& e, Visit&& visit) {
  for (const ErrorMeasure& measure : frontier_error_measures()) {
    const bool is_later = std::isnan(ImageError{}.*measure.value);
    visit(measure.key, e.*measure.value, FieldRule{.required = !is_later});
  }
  visit("flip_mean", e.flip_mean);
  visit("displayed_flip", e.displayed);
}

template <Is<SampledErrors> T, typename Visit>
void visit_fields(T& s, Visit&& visit) {
  visit("pixels", s.pixels);
  visit("picture", s.picture);
  visit("picture_in_float", s.picture_in_float);
  visit("truth", s.truth);
}

template <Is<AuthoredErrors> T, typename Visit>
void visit_fields(T& a, Visit&& visit) {
  visit("model", a.model);
  visit("total", a.total);
}

template <Is<SeedErrors> T, typename Visit>
void visit_fields(T& s, Visit&& visit) {
  visit("pictures", s.pictures);
  visit("flip_pictures", s.flip_pictures);
  visit("deviation", s.deviation);
  visit("bias_mse_rel", s.bias_mse_rel);
  visit("bias_mse_rel_error", s.bias_mse_rel_error);
}

inline constexpr std::pair<const char*, ImageError PointErrors::*> kinds_of_error[] = {
    {"model", &PointErrors::model},
    {"precision", &PointErrors::precision},
    {"technique", &PointErrors::technique},
    {"total", &PointErrors::total}};

// The errors of which there are fronts: FLIP of the complete displayed picture, against either reference.
inline constexpr const char* front_errors[] = {"total", "authored"};

// NaN: not measured.
inline double flip_of(const PointErrors& errors, const std::string& front) {
  const ImageError* error = &errors.total;
  if (front == "authored") error = errors.authored ? &errors.authored->total : nullptr;
  return error && error->displayed ? error->displayed->mean : unknown_error;
}

template <Is<SequenceFigures> T, typename Visit>
void visit_fields(T& f, Visit&& visit) {
  visit("flicker", f.flicker);
  visit("largest_flicker", f.largest_flicker);
  visit("displayed_flip", f.displayed);
}

template <Is<SequenceError> T, typename Visit>
void visit_fields(T& s, Visit&& visit) {
  visit("plain", s.plain);
  visit("filtered", s.filtered);
}

inline constexpr std::pair<const char*, SequenceError SequenceErrors::*> sequences_of_errors[] = {
    {"still", &SequenceErrors::still},
    {"dolly", &SequenceErrors::dolly},
    {"moving_lights", &SequenceErrors::moving_lights}};

template <Is<SequenceErrors> T, typename Visit>
void visit_fields(T& s, Visit&& visit) {
  visit("frames", s.frames, FieldRule{.low = 1});
  for (const auto& [key, sequence] : sequences_of_errors) visit(key, s.*sequence);
}

template <Is<PointErrors> T, typename Visit>
void visit_fields(T& e, Visit&& visit) {
  for (const auto& [key, kind] : kinds_of_error) visit(key, e.*kind);
  visit("in_double", e.in_double);
  visit("authored", e.authored);
  visit("seeds", e.seeds);
  visit("bias_rmse_rel", e.bias_rmse_rel);
  visit("deviation_rmse_rel", e.deviation_rmse_rel);
  visit("temporal_rmse_rel", e.temporal_rmse_rel);
  visit("sequences", e.sequences, FieldRule{.required = false});
  visit("surfaces", e.surfaces, FieldRule{.required = false});
}

// In the order of a round's line.
inline constexpr std::pair<const char*, std::vector<double> FrontierRecord::*> times_by_device[] = {
    {"device_ms", &FrontierRecord::device_ms},
    {"hand_over_ms", &FrontierRecord::hand_over_ms},
    {"copy_ms", &FrontierRecord::copy_ms},
    {"read_back_ms", &FrontierRecord::read_back_ms},
    {"baseline_device_ms", &FrontierRecord::baseline_device_ms}};

inline constexpr std::pair<const char*, std::vector<double> FrontierRecord::*> times_by_cpu[] = {
    {"cpu_ms", &FrontierRecord::cpu_ms}, {"baseline_cpu_ms", &FrontierRecord::baseline_cpu_ms}};

// The measured thing, without its figures.
template <Is<FrontierRecord> T, typename Visit>
void visit_identity(T& r, Visit&& visit) {
  visit_fields(r.point, visit);
  visit("view", r.view);
  visit("width", r.width);
  visit("height", r.height);
  visit("lights", r.lights);
  visit("radius_scale", r.radius_scale);
  visit("series", r.series);
}

template <Is<FrontierRecord> T, typename Visit>
void visit_fields(T& r, Visit&& visit) {
  visit_identity(r, visit);
  visit("truth", r.truth, FieldRule{.required = false});
  visit("external", r.external, FieldRule{.required = false});
  visit("overlap", r.overlap, FieldRule{.required = false});
  visit("pair_pixels", r.pair_pixels, FieldRule{.required = false});
  visit("refused", r.refused);
  visit("frame_ms", r.frame_ms);
  visit("baseline_ms", r.baseline_ms);
  for (const auto& [key, times] : times_by_device) visit(key, r.*times, FieldRule{.required = false});
  for (const auto& [key, times] : times_by_cpu) visit(key, r.*times, FieldRule{.required = false});
  visit("processes", r.processes, FieldRule{.required = false});
  visit("frames_per_round", r.frames_per_round, FieldRule{.low = 1, .required = false});
  visit("pass_ms", r.pass_ms);
  visit("pass_bytes", r.pass_bytes, FieldRule{.required = false});
  visit("cull_ms", r.cull_ms);
  visit("bytes_moved", r.bytes_moved);
  visit("memory_bytes", r.memory_bytes);
  visit("covered_pixels", r.covered_pixels);
  visit("pairs", r.pairs);
  visit("nan_pixels", r.nan_pixels);
  visit("overflow", r.overflow);
  visit("errors", r.errors);
  visit("flip_exposures", r.flip);
  visit("exposure_ev", r.exposure_ev, FieldRule{.required = false});
  visit("image", r.image);
}

template <Is<FrontierMachine> T, typename Visit>
void visit_fields(T& m, Visit&& visit) {
  const FieldRule may_miss{.required = false};
  visit("cl_device", m.cl_device);
  visit("gl_device", m.gl_device);
  visit("cl_driver", m.cl_driver);
  visit("gl_driver", m.gl_driver);
  visit("cl_kind", m.cl_kind, may_miss);
  visit("picture", m.picture, may_miss);
  visit("cpu", m.cpu);
  visit("governor", m.governor);
  visit("clock_mhz", m.clock_mhz, may_miss);
  visit("threads", m.threads);
  visit("load_at_start", m.load_at_start, may_miss);
  visit("load_at_end", m.load_at_end, may_miss);
  visit("shard", m.shard, may_miss);
}

template <Is<FrontierConditions> T, typename Visit>
void visit_fields(T& c, Visit&& visit) {
  const FieldRule may_miss{.required = false};
  visit("process", c.process);
  visit("others_percent", c.others_percent, may_miss);
  visit("steal_percent", c.steal_percent, may_miss);
  visit("clock_mhz", c.clock_mhz, may_miss);
  visit("temperature_c", c.temperature_c, may_miss);
  visit("power_w", c.power_w, may_miss);
  visit("throttles", c.throttles, may_miss);
}

// The first line of a part.
template <Is<FrontierPart> T, typename Visit>
void visit_fields(T& p, Visit&& visit) {
  visit("request", p.request);
  visit("commit", p.commit);
  visit("seed", p.seed);
  visit("shards", p.shards, FieldRule{.low = 1});
  visit("shard", p.shard);
  visit("baseline", p.baseline);
  visit("keep", p.keep, FieldRule{.required = false});
  visit("half_width", p.half_width, FieldRule{.required = false});
  visit("points_asked", p.points_asked, FieldRule{.required = false});
  visit("machine", p.machine);
}

// Parts lose nothing; what others read has null for what is not finite, and settings as numbers.
enum class Numbers { exact, finite };

// Collects visited fields as a JSON object.
struct ToJson {
  Numbers numbers = Numbers::exact;
  nlohmann::json object = nlohmann::json::object();

  template <typename T>
  void operator()(const char* key, const T& value, FieldRule = {}) {
    object[key] = json_of(value);
  }
  template <typename T>
  void operator()(const char* key, const std::optional<T>& value, FieldRule rule = {}) {
    if (value || rule.required) object[key] = json_of(value);
  }
  nlohmann::json json_of(double value) const {
    return numbers == Numbers::exact ? exact_number(value) : finite_number(value);
  }
  template <typename T>
  requires std::integral<T> || std::same_as<T, std::string> nlohmann::json json_of(const T& value)
  const { return value; }
  template <typename T>
  nlohmann::json json_of(const std::optional<T>& value) const {
    return value ? json_of(*value) : nlohmann::json();
  }
  nlohmann::json json_of(const std::optional<FlipExposures>& flip) const {
    if (!flip) return nlohmann::json::array();
    return {json_of(flip->start), json_of(flip->stop), flip->count};
  }
  nlohmann::json json_of(const std::map<std::string, std::string>& settings) const {
    return numbers == Numbers::exact ? nlohmann::json(settings) : settings_json(settings);
  }
  template <typename T>
  nlohmann::json json_of(const std::map<std::string, T>& values) const {
    nlohmann::json all = nlohmann::json::object();
    for (const auto& [key, value] : values) all[key] = json_of(value);
    return all;
  }
  template <typename T>
  nlohmann::json json_of(const std::vector<T>& values) const {
    nlohmann::json all = nlohmann::json::array();
    for (const T& value : values) all.push_back(json_of(value));
    return all;
  }
  template <typename T>
  requires requires(const T& t, ToJson& v) { visit_fields(t, v); }
  nlohmann::json json_of(const T& value) const {
    ToJson inner{numbers};
    visit_fields(value, inner);
    return inner.object;
  }
};

}  // namespace lightgrid::lab
