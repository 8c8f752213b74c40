#include "frontier/frontier_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/embedded.h"
#include "frontier/answer_steps.h"
#include "frontier/page_pictures.h"
#include "frontier/plots.h"
#include "report/page_template.h"

namespace lightgrid {
namespace {

using nlohmann::json;

json page_interval(const MedianInterval& interval) {
  if (interval.runs == 0) return nullptr;
  return {
      {"median", interval.median}, {"low", interval.low}, {"high", interval.high}, {"runs", interval.runs}};
}

// Figures that are not finite become null.
json page_errors(const ErrorFigures& errors) {
  json figures = {{"max_rel", errors.max_rel},
                  {"rmse_rel", errors.rmse_rel},
                  {"relative_rmse", errors.relative_rmse},
                  {"p99_rel", errors.p99_rel}};
  figures["flip_mean"] = errors.flip_mean ? json(*errors.flip_mean) : json();
  return figures;
}

// The first picture that a record of the point names.
std::string picture_of(const FrontierAnswer& answer, const FrontierPoint& point) {
  const std::string key = point_key(point);
  for (const FrontierRecord& r : answer.part.records) {
    if (!r.image.empty() && r.series.empty() && point_key(r.point) == key) return r.image;
  }
  return "";
}

json page_point(const FrontierAnswer& answer, const PointFigures& p, const PagePictures& pictures) {
  json point = {{"scene", p.point.scene},
                {"technique", p.point.technique},
                {"label", p.point.label},
                {"settings", p.point.settings},
                {"frames", p.point.frames},
                {"views", p.views},
                {"ms", page_interval(p.frame_ms)},
                {"ratio", page_interval(p.ratio)},
                {"listed", double(p.pairs.listed) / p.views},
                {"lit", double(p.pairs.lit) / p.views},
                {"lost", p.pairs.lost},
                {"wrong", p.pairs.wrong},
                {"nan", p.nan_pixels},
                {"memory", p.memory_bytes},
                {"moved", p.bytes_moved},
                {"front", p.front},
                {"tied", p.tied_with}};
  point["errors"] = {{"model", page_errors(p.errors.model)},
                     {"precision", page_errors(p.errors.precision)},
                     {"technique", page_errors(p.errors.technique)},
                     {"total", page_errors(p.errors.total)}};
  if (p.errors.in_double) {
    point["errors"]["in_double"] = page_errors(p.errors.in_double->picture);
    point["sampled"] = {{"pixels", p.errors.in_double->pixels},
                        {"in_float", page_errors(p.errors.in_double->picture_in_float)},
                        {"truth", page_errors(p.errors.in_double->truth)}};
  }
  point["flip_views"] = p.flip_views;
  point["temporal_views"] = p.temporal_views;
  point["bias"] = p.errors.bias_rmse_rel ? json(*p.errors.bias_rmse_rel) : json();
  point["temporal"] = p.errors.temporal_rmse_rel ? json(*p.errors.temporal_rmse_rel) : json();
  point["deviation"] = p.errors.deviation_rmse_rel ? json(*p.errors.deviation_rmse_rel) : json();
  const auto found = pictures.by_name.find(picture_of(answer, p.point));
  point["pictures"] = found == pictures.by_name.end() ? json() : json(found->second);
  return point;
}

json page_machine(const FrontierMachine& m) {
  return {{"shard", m.shard},
          {"cl_device", m.cl_device},
          {"cl_driver", m.cl_driver},
          {"gl_device", m.gl_device},
          {"gl_driver", m.gl_driver},
          {"cpu", m.cpu},
          {"governor", m.governor},
          {"clock_mhz", m.clock_mhz},
          {"threads", m.threads},
          {"load_at_start", m.load_at_start},
          {"load_at_end", m.load_at_end}};
}

json page_data_of(const FrontierAnswer& answer, const PagePictures& pictures) {
  json data = {{"commit", answer.part.commit},
               {"seed", answer.part.seed},
               {"baseline", answer.part.baseline},
               {"pictures", pictures.urls},
               {"reduced", pictures.reduced}};
  for (const char* list : {"scenes", "machines", "styles", "points", "best_within", "failures", "plots"})
    data[list] = json::array();
  for (const std::string& scene : scenes_of(answer)) {
    data["scenes"].push_back(
        {{"key", scene}, {"title", scene_in_words(scene)}, {"sentences", sentences_of_scene(answer, scene)}});
  }
  for (const FrontierMachine& m : answer.machines) data["machines"].push_back(page_machine(m));
  for (const TechniqueStyle& s : technique_styles(answer)) {
    data["styles"].push_back({{"technique", s.technique}, {"colour", s.colour}, {"marker", s.marker}});
  }
  for (const PointFigures& p : answer.points) data["points"].push_back(page_point(answer, p, pictures));
  for (const BestWithin& b : answer.best_within) {
    data["best_within"].push_back(
        {{"scene", b.scene}, {"error", b.error}, {"point", b.point}, {"tied", b.tied}});
  }
  for (const Failure& f : answer.failures) {
    data["failures"].push_back(
        {{"scene", f.point.scene}, {"label", f.point.label}, {"cause", f.cause}, {"why", f.why}});
  }
  for (const Plot& plot : plots_of(answer)) {
    if (plot.kind == "front") continue;  // drawn by front.js
    data["plots"].push_back({{"kind", plot.kind},
                             {"scene", plot.scene},
                             {"title", plot.title},
                             {"name", plot.name},
                             {"svg", plot.svg}});
  }
  return data;
}

}  // namespace

std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures,
                      size_t most_picture_bytes) {
  std::vector<std::string> names;
  if (!pictures.empty()) {
    for (const FrontierRecord& r : answer.part.records) names.push_back(r.image);
  }
  std::string style = embedded_file("report/page/style.css"), script;
  style += embedded_file("frontier/page/frontier.css");
  for (const char* name : {"report/page/elements.js", "report/page/table.js", "frontier/page/figures.js",
                           "frontier/page/front.js", "frontier/page/frontier.js"}) {
    script += embedded_file(name);
  }
  const json data = page_data_of(answer, page_pictures(pictures, names, most_picture_bytes));
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  return filled(embedded_file("frontier/page/index.html"),
                {{"style", style}, {"script", script}, {"page", script_json(text)}});
}

}  // namespace lightgrid
