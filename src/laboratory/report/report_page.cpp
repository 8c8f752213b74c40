#include "report/report.h"

#include <nlohmann/json.hpp>

#include "base/embedded.h"
#include "base/image.h"
#include "base/text.h"
#include "measures/error_measures.h"
#include "measures/metrics.h"
#include "measures/words.h"
#include "report/charts.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;

// Pictures by number; techniques with identical pictures share one.
class PictureStore {
 public:
  json number_of(const std::vector<uint8_t>& png) {
    if (png.empty()) return nullptr;
    auto url = "data:image/png;base64," + base64(png);
    const auto [found, added] = number_.emplace(std::move(url), number_.size());
    if (added) urls_.push_back(found->first);
    return found->second;
  }
  const json& urls() const { return urls_; }

 private:
  std::map<std::string, size_t> number_;
  json urls_ = json::array();
};

std::vector<uint8_t> legend_png(const Ramp& ramp) {
  std::vector<uint8_t> bytes;
  for (const auto& colour : ramp) bytes.insert(bytes.end(), {colour.r, colour.g, colour.b});
  return encode_png(static_cast<int>(ramp.size()), 1, 3, bytes);
}

json heat_entry(PictureStore& store, const std::optional<HeatMap>& heat) {
  if (!heat) return nullptr;
  return {{"picture", store.number_of(heat->png)}, {"mean", heat->mean}, {"max", heat->max}};
}

// "exact", "lossy", "failed", "refused", or "unjudged": what its light is judged by was not drawn.
const char* standing_of(const RunResult& row) {
  if (!row.refused.empty()) return "refused";
  if (!passes_gates(row)) return "failed";
  return is_exact(row) ? "exact" : row.error && !light_error(row) ? "unjudged" : "lossy";
}

json to_json(const Curve& curve) {
  json points = json::array();
  for (const CurvePoint& p : curve.points) {
    points.push_back({{"x", p.x}, {"ms", p.ms}, {"exact", p.exact}, {"view", p.view}, {"row", p.row}});
  }
  return {{"name", curve.name}, {"flat", curve.flat}, {"points", points}};
}

json to_json(const std::vector<Chart>& charts) {
  json list = json::array();
  for (const Chart& chart : charts) {
    json ticks = json::array(), curves = json::array(), crossings = json::array();
    for (const Tick& t : chart.ticks) ticks.push_back({{"x", t.x}, {"label", t.label}});
    for (const Curve& c : chart.curves) curves.push_back(to_json(c));
    for (const Crossing& c : chart.crossings) {
      crossings.push_back(
          {{"below", c.below}, {"above", c.above}, {"x", c.x}, {"ms", c.ms}, {"lead", c.lead}});
    }
    list.push_back({{"title", chart.title},
                    {"axis", chart.axis},
                    {"kept", chart.kept},
                    {"ticks", ticks},
                    {"curves", curves},
                    {"crossings", crossings},
                    {"sentences", chart.sentences}});
  }
  return list;
}

json view_data(PictureStore& store, const std::vector<ReportView>& views, size_t v) {
  const ReportView& view = views[v];
  const RunResult* winner = fastest_exact(view.report);
  json rows = json::array();
  for (size_t i = 0; i < view.report.rows.size(); ++i) {
    const RunResult& row = view.report.rows[i];
    const RowPictures& pictures = view.pictures.rows[i];
    rows.push_back({{"name", pictures.name},
                    {"standing", standing_of(row)},
                    {"winner", &row == winner},
                    {"why_lost", why_lost(row)},
                    {"image", store.number_of(pictures.image)},
                    {"difference", store.number_of(pictures.difference)},
                    {"listed", heat_entry(store, pictures.listed)}});
  }
  json answers = json::array();
  for (const Choice& c : view.choices)
    answers.push_back(
        {{"what", c.what}, {"name", c.name}, {"figure", c.figure}, {"why", c.why}, {"sure", c.sure}});
  const RunResult* reference = reference_row(view.report);
  const bool reference_ran = reference && reference->refused.empty();
  return {{"title", view_in_words(view.report)},
          {"folder", view.folder},
          {"reduced", view.pictures.reduced},
          {"verdict", view.verdict},
          {"choices", answers},
          {"figures", view.figures},
          {"rows", rows},
          {"reference", store.number_of(view.pictures.reference)},
          {"reference_row", reference_ran ? json(reference - view.report.rows.data()) : json()},
          {"lit", heat_entry(store, view.pictures.lit)},
          {"heat_top", view.pictures.heat_top},
          {"charts", to_json(charts_over_settings(views, v))}};
}

// The page's data besides results.json.
json page_data(const std::vector<ReportView>& views) {
  PictureStore store;
  json list = json::array();
  for (size_t v = 0; v < views.size(); ++v) list.push_back(view_data(store, views, v));
  json data = {
      {"views", list},
      {"overview", {{"sentences", overview_sentences(views)}, {"charts", to_json(charts_over_views(views))}}},
      {"difference_legend", store.number_of(legend_png(difference_ramp()))},
      {"heat_legend", store.number_of(legend_png(viridis_ramp()))}};
  data["pictures"] = store.urls();
  data["measures"] = json::array();
  for (const ErrorMeasure& measure : error_measures()) {
    if (*measure.title) data["measures"].push_back({{"key", measure.key}, {"title", measure.title}});
  }
  return data;
}

}  // namespace

std::string script_json(const std::string& text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string filled(std::string_view page, const std::map<std::string_view, std::string>& values) {
  std::string text;
  while (true) {
    const size_t open = page.find("{{"), close = page.find("}}", open);
    if (open == page.npos || close == page.npos) return text.append(page);
    text.append(page.substr(0, open));
    text.append(values.at(page.substr(open + 2, close - open - 2)));
    page.remove_prefix(close + 2);
  }
}

std::string report_page(const std::vector<ReportView>& views) {
  std::string scripts;
  for (const char* name : {"elements.js", "slider.js", "bars.js", "table.js", "plot.js", "charts.js",
                           "matrix.js", "view.js", "report.js"}) {
    scripts += embedded_file(std::string("report/page/") + name);
  }
  const json results = views.size() == 1 ? lab::to_json(views.front().report) : lab::to_json(views);
  return filled(embedded_file("report/page/index.html"),
                {{"style", embedded_file("report/page/style.css")},
                 {"script", scripts},
                 {"results", script_json(json_text(results))},
                 {"page", script_json(json_text(page_data(views)))}});
}

}  // namespace lightgrid::lab
