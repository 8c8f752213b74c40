// The folder of an answer, and its page.
#include "base/embedded.h"
#include "base/error.h"
#include "base/write_file.h"
#include "frontier/answer_steps.h"
#include "frontier/pictures.h"
#include "measures/error_measures.h"
#include "measures/words.h"
#include "report/report.h"

namespace lightgrid::lab {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

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

std::string page_text(const FrontierAnswer& answer, const std::filesystem::path& pictures,
                      size_t max_picture_bytes) {
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
  const json data = page_data_of(answer, page_pictures(pictures, names, max_picture_bytes));
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

}  // namespace lightgrid::lab
