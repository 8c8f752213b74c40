#include "frontier/answer_files.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/embedded.h"
#include "frontier/answer_steps.h"
#include "frontier/pictures.h"
#include "report/page_template.h"
#include "results/error_measures.h"

namespace lightgrid {
namespace {

using nlohmann::json;

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
    data["scenes"].push_back(
        {{"key", scene}, {"title", scene_in_words(scene)}, {"sentences", sentences_of_scene(answer, scene)}});
  }
  json& techniques = data["techniques"] = json::array();  // in the order of their colors
  for (const FrontierRecord& r : answer.part.records) {
    if (std::find(techniques.begin(), techniques.end(), r.point.technique) == techniques.end())
      techniques.push_back(r.point.technique);
  }
  for (const ErrorMeasure& measure : frontier_error_measures())
    data["measures"].push_back({{"key", measure.key}, {"title", measure.frontier_title}});
  data["measures"].push_back({{"key", "flip_mean"}, {"title", "FLIP, mean"}});
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
  for (const char* name :
       {"report/page/elements.js", "report/page/table.js", "report/page/plot.js", "frontier/page/figures.js",
        "frontier/page/front.js", "frontier/page/costs.js", "frontier/page/frontier.js"}) {
    script += embedded_file(name);
  }
  const json data = page_data_of(answer, page_pictures(pictures, names, most_picture_bytes));
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  return filled(embedded_file("frontier/page/index.html"),
                {{"style", style}, {"script", script}, {"page", script_json(text)}});
}

}  // namespace lightgrid
