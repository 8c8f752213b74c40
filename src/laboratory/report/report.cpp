#include "report/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "base/write_file.h"
#include "measures/error_measures.h"
#include "measures/words.h"

namespace lightgrid::lab {
namespace {

namespace fs = std::filesystem;

// "hall-1280x720-237": the scene without folders and extension, the size, the number of lights.
std::string view_stem(const CompareReport& report) {
  const int lights = report.rows.empty() ? 0 : report.rows.front().lights_total;
  return file_stem(fmt::format("{}-{}x{}-{}", short_scene(report), report.width, report.height, lights));
}

CompareReport without_images(const CompareReport& report) {
  CompareReport rest;
  rest.scene = report.scene;
  rest.width = report.width;
  rest.height = report.height;
  rest.ambient = report.ambient;
  rest.cl_device = report.cl_device;
  rest.gl_device = report.gl_device;
  rest.commit = report.commit;
  rest.reference = report.reference;
  rest.reference_pixels = report.reference_pixels;
  rest.rows = report.rows;
  rest.reference_surfaces = report.reference_surfaces;
  rest.brightest = report.brightest;
  rest.covered_pixels = report.covered_pixels;
  rest.own_surfaces = report.own_surfaces;
  rest.reference_errors = report.reference_errors;
  rest.path_memory = report.path_memory;
  rest.exposure = report.exposure;
  rest.warnings = report.warnings;
  rest.lights_kept = report.lights_kept;
  rest.ranges_of = report.ranges_of;
  return rest;
}

ReportView finished_view(const fs::path& folder, const CompareReport& report, bool exr, size_t max_bytes) {
  ReportView view;
  view.verdict = verdict(report);
  view.choices = choices(report);
  view.figures = remarks(report);
  view.pictures = save_pictures(folder, report, exr, max_bytes);
  view.report = without_images(report);
  return view;
}

// The effects of any row.
using EffectKeys = std::set<std::pair<std::string, std::string>>;

std::vector<CsvColumn> csv_columns(bool shadows, const EffectKeys& effects) {
  std::vector<CsvColumn> all;
  add_columns(all, {"commit", "cl", "gl", "scene", "size"});
  all.push_back({"lights", "/lights/total"});
  all.push_back({"in_view", "/lights/in_view"});
  add_columns(all, {"technique", "settings", "row", "refused"});
  for (const char* key : {"min", "median", "max"})
    all.push_back({std::string(key) + "_ms", std::string("/frame_ms/") + key});
  add_columns(all, {"runs"}, "/frame_ms");
  all.push_back({"memory", "/memory_bytes/total"});
  add_columns(all, {"light_grid", "gbuffer"}, "/memory_bytes");
  add_columns(all, {"listed", "lit", "lost", "wrong"}, "/pairs");
  if (shadows) add_columns(all, {"leaked", "acned", "either", "shadow_pixels", "shadow_pairs"}, "/pairs");
  for (const ErrorMeasure& measure : error_measures()) add_columns(all, {measure.key}, "/error");
  add_columns(all, {"bit_identical"}, "/error");
  add_columns(all, {"nan_pixels", "overflow"});
  add_columns(all, {"max_rel", "rmse_rel", "of_reference_max_rel"}, "/error/oracle", "oracle_");
  add_columns(all, {"reference_pixels"});
  add_columns(all, {"pixels", "sum_rel", "max_rel", "rmse_rel", "p99_rel"}, "/error/surfaces", "surfaces_");
  add_columns(all, {"reference", "bit_identical", "max_rel", "rmse_rel"}, "/same_surfaces", "same_surfaces_");
  for (const auto& [effect, key] : effects)
    all.push_back({effect + '_' + key, "/effects/" + effect + '/' + key});
  return all;
}

// A row as in results.json, with what is said of its view and its name.
nlohmann::json csv_row(const CompareReport& report, const RunResult& row, const std::string& name) {
  nlohmann::json fields = to_json(row);
  fields.update({{"commit", report.commit},
                 {"cl", report.cl_device},
                 {"gl", report.gl_device},
                 {"scene", report.scene},
                 {"size", fmt::format("{}x{}", report.width, report.height)},
                 {"settings", settings_field(row.settings)},
                 {"row", name},
                 {"reference_pixels", report.reference_pixels}});
  if (!row.refused.empty()) fields["nan_pixels"] = fields["overflow"] = nullptr;
  return fields;
}

// The settings of `row` that differ in another row of its technique: "tile=32,cull-test=aabb".
std::string differing_settings(const std::vector<RunResult>& rows, const RunResult& row,
                               const std::string& ignored) {
  std::vector<std::string> differing;
  for (const auto& setting : row.settings) {
    if (setting.first == ignored) continue;
    const bool differs = std::any_of(rows.begin(), rows.end(), [&](const RunResult& other) {
      const auto found = other.settings.find(setting.first);
      return other.technique == row.technique && (found == other.settings.end() || *found != setting);
    });
    if (differs) differing.push_back(spelled_setting(setting.first) + "=" + setting.second);
  }
  return fmt::format("{}", fmt::join(differing, ","));
}

// `names`, with -2, -3 and so on appended to repetitions.
std::vector<std::string> made_distinct(std::vector<std::string> names) {
  std::map<std::string, int> seen;
  for (std::string& name : names) {
    const int number = ++seen[name];
    if (number > 1) name += fmt::format("-{}", number);
  }
  return names;
}

}  // namespace

std::vector<std::string> row_names_without(const CompareReport& report, const std::string& key) {
  std::vector<std::string> names;
  for (const RunResult& row : report.rows) {
    const std::string settings = differing_settings(report.rows, row, key);
    names.push_back(settings.empty() ? row.technique : row.technique + ":" + settings);
  }
  return names;
}

std::vector<std::string> row_names(const CompareReport& report) {
  return made_distinct(row_names_without(report, ""));
}

std::string row_name(const CompareReport& report, const RunResult& row) {
  return row_names(report)[size_t(&row - report.rows.data())];
}

std::string file_stem(const std::string& name) {
  std::string stem = name;
  for (char& c : stem) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) || std::string_view("._=+-").find(c) != std::string::npos;
    if (!plain) c = '-';
  }
  return stem;
}

std::vector<std::string> file_stems(const std::vector<std::string>& names) {
  std::vector<std::string> stems;
  for (const std::string& name : names) stems.push_back(file_stem(name));
  return made_distinct(std::move(stems));
}

nlohmann::json to_json(const std::vector<ReportView>& views) {
  nlohmann::json list = nlohmann::json::array();
  for (const ReportView& view : views) list.push_back(to_json(view.report));
  return {{"views", list}};
}

std::string results_csv(const std::vector<ReportView>& views) {
  std::vector<nlohmann::json> rows;
  bool shadows = false;
  EffectKeys effects;
  for (const ReportView& view : views) {
    for (const RunResult& row : view.report.rows) {
      shadows |= row.pairs && row.pairs->shadows;
      for (const auto& [effect, figures] : row.effects) {
        for (const auto& figure : figures) effects.emplace(effect, figure.first);
      }
    }
    const auto names = row_names(view.report);
    for (size_t i = 0; i < names.size(); ++i)
      rows.push_back(csv_row(view.report, view.report.rows[i], names[i]));
  }
  return csv_table(csv_columns(shadows, effects), rows);
}

void write_report(const fs::path& folder, const CompareReport& report, bool exr) {
  const std::string json = json_text(report);
  std::vector<ReportView> views;
  views.push_back(finished_view(folder, report, exr, 0));
  write_file(folder / "results.json", json);
  write_file(folder / "index.html", report_page(views));
}

const ReportView& ViewsReport::add(CompareReport report) {
  const std::string stem = view_stem(report);
  std::string name = stem;
  for (int i = 2; names_.count(name); ++i) name = fmt::format("{}-{}", stem, i);
  names_.insert(name);
  views_.push_back(finished_view(folder_ / name, report, false, page_bytes_ / expected_));
  views_.back().folder = name;
  return views_.back();
}

std::vector<std::string> ViewsReport::sentences() const { return overview_sentences(views_); }

std::string ViewsReport::json_text() const { return lab::json_text(to_json(views_)); }

void ViewsReport::write() const {
  write_file(folder_ / "results.json", json_text());
  write_file(folder_ / "results.csv", results_csv(views_));
  write_file(folder_ / "index.html", report_page(views_));
}

}  // namespace lightgrid::lab
