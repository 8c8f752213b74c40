#include "study/report_page.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/embedded.h"
#include "base/image.h"
#include "study/metrics.h"
#include "study/report.h"

namespace lightgrid {
namespace {

using nlohmann::json;

std::string base64(const std::vector<uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t left = bytes.size() - i;
    const uint32_t group =
        bytes[i] << 16 | (left > 1 ? bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0);
    text += digits[group >> 18];
    text += digits[group >> 12 & 63];
    text += left > 1 ? digits[group >> 6 & 63] : '=';
    text += left > 2 ? digits[group & 63] : '=';
  }
  return text;
}

// Pictures by number; techniques that agree to the last byte share one.
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

// What the page shows beside results.json.
json page_data(const CompareReport& report, const ReportPictures& pictures) {
  PictureStore store;
  json rows = json::array();
  for (const auto& row : pictures.rows) {
    rows.push_back({{"name", row.name},
                    {"image", store.number_of(row.image)},
                    {"difference", store.number_of(row.difference)},
                    {"listed", heat_entry(store, row.listed)}});
  }
  json data = {{"verdict", verdict(report)},
               {"figures", telling_figures(report)},
               {"rows", rows},
               {"reference", store.number_of(pictures.reference)},
               {"lit", heat_entry(store, pictures.lit)},
               {"heat_top", pictures.heat_top},
               {"difference_legend", store.number_of(legend_png(difference_ramp()))},
               {"heat_legend", store.number_of(legend_png(viridis_ramp()))}};
  data["pictures"] = store.urls();
  return data;
}

// Safe inside <script>: no "<" is left, so no "</script>" either.
std::string script_json(std::string text) {
  std::string safe;
  safe.reserve(text.size());
  for (char c : text) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

// Each {{name}} of the template once, in order; what is put in is not looked at again.
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

}  // namespace

std::string report_page(const CompareReport& report, const ReportPictures& pictures) {
  std::string scripts;
  for (const char* name : {"elements.js", "slider.js", "time_bars.js", "table.js", "report.js"}) {
    scripts += embedded_file(std::string("study/report/") + name);
  }
  return filled(embedded_file("study/report/index.html"),
                {{"style", embedded_file("study/report/style.css")},
                 {"script", scripts},
                 {"results", script_json(json_text(to_json(report)))},
                 {"page", script_json(json_text(page_data(report, pictures)))}});
}

}  // namespace lightgrid
