// lightgrid compare SCENE… -t A,B,… -o DIR: images, results.json and index.html.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "compare/comparison.h"
#include "measures/words.h"
#include "report/against.h"
#include "report/report.h"
#include "report/speedup_words.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct CompareCommand {
  CompareChoice choice;
  std::string output = "out/compare", json, against;
  bool exr = false;
  int page_mb = 30;
};

// Refused rows, which are no failures, become warnings of the report.
void warn_of_refusals(CompareReport& report, const std::string& view) {
  const WarningCollector collector;
  const std::vector<std::string> names = row_names(report);
  for (size_t i = 0; i < names.size(); ++i)
    if (!report.rows[i].refused.empty())
      log_warning("{}{}: refused: {}", view, names[i], report.rows[i].refused);
  add_distinct(report.warnings, collector.warnings());
}

// Prints on stderr which gates failed. Returns whether any did.
bool tell_failures(const CompareReport& report, const std::string& view) {
  const std::vector<std::string> names = row_names(report);
  bool failed = false;
  for (size_t i = 0; i < names.size(); ++i) {
    const RunResult& row = report.rows[i];
    if (!row.refused.empty() || passes_gates(row)) continue;
    failed = true;
    if (row.pairs->lost || row.pairs->wrong || row.nan_pixels)
      fmt::print(stderr, "lightgrid: {}{}: {} lost{} and {} wrong pairs, {} NaN pixels; all must be 0\n",
                 view, names[i], row.pairs->lost, why_lost(row), row.pairs->wrong, row.nan_pixels);
    if (row.pairs->shadows && row.pairs->shadows->faults() > 0)
      fmt::print(stderr, "lightgrid: {}{}: {} leaked and {} acned pairs; exact shadows have none\n", view,
                 names[i], row.pairs->shadows->leaked, row.pairs->shadows->acned);
    if (row.pairs->blended && row.pairs->blended->faults() > 0)
      fmt::print(stderr, "lightgrid: {}{}: {} leaked and {} acned pairs of blended surfaces\n", view,
                 names[i], row.pairs->blended->leaked, row.pairs->blended->acned);
    if (row.unshaded.value_or(0) > max_unshaded)
      fmt::print(stderr,
                 "lightgrid: {}{}: its lists hold every light, but its image lacks {:.3g} % of their light\n",
                 view, names[i], 100 * *row.unshaded);
  }
  return failed;
}

// Prints what is worse than in an earlier results.json. Returns whether anything is.
bool is_worse(const CompareCommand& o, const nlohmann::json& earlier, const nlohmann::json& now) {
  if (o.against.empty()) return false;
  const AgainstResult result = results_against(now, earlier, o.against);
  for (const std::string& note : result.told) log_info("against {}: {}", o.against, note);
  for (const std::string& fault : result.worse)
    fmt::print(stderr, "lightgrid: against {}: {}\n", o.against, fault);
  return !result.worse.empty();
}

// The command of the first warning that has one; else a step that this page does not take.
std::string next_step(const CompareCommand& o, const std::vector<Warning>& warnings) {
  for (const Warning& warning : warnings)
    if (!warning.command.empty()) return warning.command;
  return "lightgrid frontier " + fmt::format("{}", fmt::join(o.choice.scenes, " ")) +
         "  (which setting is the fastest for which error)";
}

void print_report(const CompareCommand& o, const std::string& json, const std::vector<std::string>& figures,
                  const std::vector<std::string>& tables, const std::vector<Warning>& warnings) {
  if (!o.json.empty()) write_json(o.json, json);
  if (o.json == "-") return;
  fmt::print("{}\n", (std::filesystem::path(o.output) / "index.html").string());
  for (const std::string& figure : figures) fmt::print("  {}\n", figure);
  for (const std::string& line : tables) fmt::print("{}\n", line.empty() ? "" : "  " + line);
  fmt::print("\n  Next: {}\n", next_step(o, warnings));
}

// After an empty line; `view` is its heading.
std::vector<std::string> table_of(const CompareReport& report, const std::string& view) {
  std::vector<std::string> lines = {""};
  if (!view.empty()) lines.push_back(view);
  std::ranges::copy(contestants_table(report), std::back_inserter(lines));
  return lines;
}

int compare_one(const CompareCommand& o, Comparison comparison, const nlohmann::json& earlier) {
  CompareReport report;
  run_comparison(comparison, progress_bar(), [&](CompareReport found) { report = std::move(found); });
  warn_of_refusals(report, "");
  comparison = {};  // pictures and pages are made without the scene
  write_report(o.output, report, o.exr);
  print_report(o, json_text(report), telling_figures(report), table_of(report, ""), report.warnings);
  const bool failed = tell_failures(report, "");
  return is_worse(o, earlier, to_json(report)) || failed ? 1 : 0;
}

int compare_several(const CompareCommand& o, const Comparison& comparison, const nlohmann::json& earlier) {
  ViewsReport report(o.output, comparison.views.size(), size_t(o.page_mb) << 20);
  bool failed = false;
  std::vector<std::string> tables;
  std::vector<Warning> warnings;
  run_comparison(comparison, progress_bar(), [&](CompareReport found) {
    warn_of_refusals(found, view_in_words(found) + ": ");
    add_distinct(warnings, found.warnings);
    const ReportView& view = report.add(std::move(found));
    std::ranges::copy(table_of(view.report, view_in_words(view.report)), std::back_inserter(tables));
    failed |= tell_failures(view.report, view_in_words(view.report) + ": ");
  });
  report.write();
  print_report(o, report.json_text(), report.sentences(), tables, warnings);
  return is_worse(o, earlier, to_json(report.views())) || failed ? 1 : 0;
}

int compare(const CompareCommand& o) {
  const nlohmann::json earlier = o.against.empty() ? nlohmann::json() : read_results_json(o.against);
  Comparison comparison = load_comparison(o.choice);
  if (!o.json.empty()) check_output_file("--json", o.json);
  return with_output_folder(o.output, [&] {
    return comparison.views.size() == 1 ? compare_one(o, std::move(comparison), earlier)
                                        : compare_several(o, comparison, earlier);
  });
}

}  // namespace

void add_compare(CommandLine& line) {
  auto o = std::make_shared<CompareCommand>();
  CompareChoice& c = o->choice;
  Subcommand command =
      line.add("compare", "techniques side by side, as a report", [o] { return compare(*o); });
  command.list("scene", c.scenes, "one or more: .gltf or .glb files, or built-in scenes");
  command.list("--size", c.sizes, "image size, WxH, or several separated by commas", ',');
  command.list("--lights", c.lights,
               "scatter N lights; with --lights-file, its first N; or several separated by commas", ',');
  add_keep_option(command, c.keep);
  add_view_options(command, c.scene);
  add_path_option(command, c.scene);
  add_exposure_option(command, c.scene);
  add_device_options(command, c.devices);
  add_timing_options(command, c.timing);
  command.list("-t,--technique,--techniques", c.techniques,
               "NAME[:KEY=VALUE[,KEY=VALUE…]], separated by commas; names are all, " + technique_names() +
                   fmt::format(" (default: {})", fmt::join(default_techniques(), ",")),
               ',');
  command.list("--compare", c.compare,
               "KEY=VALUE,VALUE,…: each technique that reads KEY, with each value; may be repeated");
  command.option("--reference", c.reference,
                 "pixels of the brute-force image: full, sampled, or auto (sampled past a minute)");
  command.flag("--flip", c.flip, "also measures HDR-FLIP, which takes seconds per row");
  command.option("-o,--output", o->output, "folder of the report");
  command.flag("--exr", o->exr, "with one view: each picture as a linear .exr file too");
  command.option("--page-mb", o->page_mb, "with several views: limit of pictures in the page in MiB", 1,
                 1000);
  command.option("--against", o->against,
                 "an earlier results.json: exit 1 if a row is slower or less exact, and say which");
  command.option("--json", o->json, "results.json also into a file, - for stdout");
}

}  // namespace lightgrid::app
