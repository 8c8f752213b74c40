#include "report/report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "base/write_file.h"
#include "report/overview.h"
#include "report/report_page.h"
#include "report/results_csv.h"
#include "results/words.h"

namespace lightgrid {
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
  rest.width = report.width, rest.height = report.height, rest.ambient = report.ambient;
  rest.cl_device = report.cl_device, rest.gl_device = report.gl_device, rest.commit = report.commit;
  rest.reference = report.reference, rest.reference_pixels = report.reference_pixels;
  rest.rows = report.rows;
  rest.reference_surfaces = report.reference_surfaces;
  rest.brightest = report.brightest, rest.covered_pixels = report.covered_pixels;
  rest.own_surfaces = report.own_surfaces;
  rest.reference_errors = report.reference_errors;
  rest.path_memory = report.path_memory;
  return rest;
}

ReportView finished_view(const fs::path& folder, const CompareReport& report, bool exr, size_t most_bytes) {
  ReportView view;
  view.verdict = verdict(report);
  view.choices = choices(report);
  view.figures = remarks(report);
  view.pictures = save_pictures(folder, report, exr, most_bytes);
  view.report = without_images(report);
  return view;
}

}  // namespace


nlohmann::json to_json(const std::vector<ReportView>& views) {
  nlohmann::json list = nlohmann::json::array();
  for (const ReportView& view : views) list.push_back(to_json(view.report));
  return {{"views", list}};
}

void write_report(const fs::path& folder, const CompareReport& report) {
  const std::string json = json_text(report);
  std::vector<ReportView> views;
  views.push_back(finished_view(folder, report, true, 0));
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

std::string ViewsReport::json_text() const { return lightgrid::json_text(to_json(views_)); }

void ViewsReport::write() const {
  write_file(folder_ / "results.json", json_text());
  write_file(folder_ / "results.csv", results_csv(views_));
  write_file(folder_ / "index.html", report_page(views_));
}

}  // namespace lightgrid
