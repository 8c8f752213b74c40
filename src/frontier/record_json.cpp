// Records, machines and their content hash.
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "frontier/json_fields.h"
#include "frontier/record_file.h"
#include "results/error_measures.h"

namespace lightgrid {
namespace {

using nlohmann::json;

json optional_json(const std::optional<double>& value) { return value ? exact_number(*value) : json(); }

json figures_json(const ImageError& e) {
  json figures = {{"flip_mean", optional_json(e.flip_mean)}};
  for (const ErrorMeasure& measure : frontier_error_measures())
    figures[measure.key] = exact_number(e.*measure.value);
  return figures;
}

ImageError figures_of(const JsonFields& fields) {
  ImageError error;
  for (const ErrorMeasure& measure : frontier_error_measures())
    error.*measure.value = fields.number(measure.key);
  error.flip_mean = fields.optional_number("flip_mean");
  return error;
}

json sampled_json(const std::optional<SampledErrors>& sampled) {
  if (!sampled) return {};
  return {{"pixels", sampled->pixels},
          {"picture", figures_json(sampled->picture)},
          {"picture_in_float", figures_json(sampled->picture_in_float)},
          {"truth", figures_json(sampled->truth)}};
}

std::optional<SampledErrors> sampled_of(const JsonFields& errors) {
  if (!errors.has("in_double")) return {};
  const JsonFields fields = errors.object("in_double");
  return SampledErrors{fields.whole("pixels", 0), figures_of(fields.object("picture")),
                       figures_of(fields.object("picture_in_float")),
                       figures_of(fields.object("truth"))};
}

json errors_json(const PointErrors& errors) {
  return {{"model", figures_json(errors.model)},
          {"precision", figures_json(errors.precision)},
          {"technique", figures_json(errors.technique)},
          {"total", figures_json(errors.total)},
          {"in_double", sampled_json(errors.in_double)},
          {"bias_rmse_rel", optional_json(errors.bias_rmse_rel)},
          {"deviation_rmse_rel", optional_json(errors.deviation_rmse_rel)},
          {"temporal_rmse_rel", optional_json(errors.temporal_rmse_rel)}};
}

PointErrors errors_of(const JsonFields& fields) {
  return {.model = figures_of(fields.object("model")),
          .precision = figures_of(fields.object("precision")),
          .technique = figures_of(fields.object("technique")),
          .total = figures_of(fields.object("total")),
          .in_double = sampled_of(fields),
          .bias_rmse_rel = fields.optional_number("bias_rmse_rel"),
          .deviation_rmse_rel = fields.optional_number("deviation_rmse_rel"),
          .temporal_rmse_rel = fields.optional_number("temporal_rmse_rel")};
}

json numbers_json(const std::vector<double>& values) {
  json array = json::array();
  for (const double value : values) array.push_back(exact_number(value));
  return array;
}

// What is measured, without what came out.
json identity_json(const FrontierRecord& r) {
  return {{"scene", r.point.scene},
          {"technique", r.point.technique},
          {"settings", r.point.settings},
          {"label", r.point.label},
          {"frames", r.point.frames},
          {"view", r.view},
          {"width", r.width},
          {"height", r.height},
          {"lights", r.lights},
          {"radius_scale", exact_number(r.radius_scale)},
          {"series", r.series}};
}

}  // namespace

std::string content_hash(const std::string& text) {
  uint64_t hash = 0xcbf29ce484222325;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", hash);
}

std::string record_key(const FrontierRecord& record) {
  // As the file has it, so that a record that was read back has the same key.
  return content_hash(identity_json(record).dump(-1, ' ', false, json::error_handler_t::replace));
}

json to_json(const FrontierRecord& r) {
  json line = identity_json(r);
  line["refused"] = r.refused;
  line["frame_ms"] = numbers_json(r.frame_ms);
  line["baseline_ms"] = numbers_json(r.baseline_ms);
  line["pass_ms"] = json::object();
  for (const auto& [pass, ms] : r.pass_ms) line["pass_ms"][pass] = exact_number(ms);
  line["cull_ms"] = numbers_json(r.cull_ms);
  line["bytes_moved"] = r.bytes_moved;
  line["memory_bytes"] = r.memory_bytes;
  line["covered_pixels"] = r.covered_pixels;
  line["pairs"] = {
      {"listed", r.pairs.listed}, {"lit", r.pairs.lit}, {"lost", r.pairs.lost}, {"wrong", r.pairs.wrong}};
  line["nan_pixels"] = r.nan_pixels;
  line["overflow"] = r.overflow;
  line["errors"] = errors_json(r.errors);
  line["flip_exposures"] =
      r.flip ? json{exact_number(r.flip->start), exact_number(r.flip->stop), r.flip->count} : json::array();
  line["image"] = r.image;
  return line;
}

FrontierRecord record_of(const json& line) {
  const JsonFields fields(line);
  FrontierRecord r;
  r.point.scene = fields.text("scene");
  r.point.technique = fields.text("technique");
  r.point.label = fields.text("label");
  r.point.frames = fields.whole("frames", 1);
  const JsonFields settings = fields.object("settings"), passes = fields.object("pass_ms"),
                   pairs = fields.object("pairs");
  for (const std::string& name : settings.names()) r.point.settings[name] = settings.text(name);
  r.view = fields.whole("view", 0);
  r.width = fields.whole("width", 0);
  r.height = fields.whole("height", 0);
  r.lights = fields.whole("lights", 0);
  r.radius_scale = fields.number("radius_scale");
  r.series = fields.text("series");
  r.refused = fields.text("refused");
  r.frame_ms = fields.numbers("frame_ms");
  r.baseline_ms = fields.numbers("baseline_ms");
  if (r.frame_ms.size() != r.baseline_ms.size()) {
    throw input_error("frame_ms: {} times beside {} of baseline_ms", r.frame_ms.size(), r.baseline_ms.size());
  }
  for (const std::string& name : passes.names()) r.pass_ms[name] = passes.number(name);
  r.cull_ms = fields.numbers("cull_ms");
  r.bytes_moved = fields.count("bytes_moved");
  r.memory_bytes = fields.count("memory_bytes");
  r.covered_pixels = fields.count("covered_pixels");
  r.pairs = {pairs.count("listed"), pairs.count("lit"), pairs.count("lost"), pairs.count("wrong")};
  r.nan_pixels = fields.count("nan_pixels");
  r.overflow = fields.count("overflow");
  r.errors = errors_of(fields.object("errors"));
  const std::vector<double> flip = fields.numbers("flip_exposures");
  if (!flip.empty()) {
    if (flip.size() != 3) throw input_error("flip_exposures: not start, stop and count");
    r.flip = FlipExposures{flip[0], flip[1], int(flip[2])};
  }
  r.image = fields.text("image");
  return r;
}

json to_json(const FrontierMachine& m) {
  return {{"cl_device", m.cl_device},
          {"gl_device", m.gl_device},
          {"cl_driver", m.cl_driver},
          {"gl_driver", m.gl_driver},
          {"cpu", m.cpu},
          {"governor", m.governor},
          {"clock_mhz", finite_number(m.clock_mhz)},
          {"threads", m.threads},
          {"load_at_start", finite_number(m.load_at_start)},
          {"load_at_end", finite_number(m.load_at_end)},
          {"shard", m.shard}};
}

FrontierMachine machine_of(const json& object) {
  const JsonFields fields(object, "machine.");
  FrontierMachine m;
  m.cl_device = fields.text("cl_device");
  m.gl_device = fields.text("gl_device");
  m.cl_driver = fields.text("cl_driver");
  m.gl_driver = fields.text("gl_driver");
  m.cpu = fields.text("cpu");
  m.governor = fields.text("governor");
  m.clock_mhz = fields.optional_number("clock_mhz").value_or(0);
  m.threads = fields.whole("threads", 0);
  m.load_at_start = fields.optional_number("load_at_start").value_or(0);
  m.load_at_end = fields.optional_number("load_at_end").value_or(0);
  return m;
}

}  // namespace lightgrid
