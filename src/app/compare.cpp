// lightgrid compare SCENE -t A,B,… -o DIR: images, results.json and index.html.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress.h"
#include "base/error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "study/compare.h"
#include "study/report.h"

namespace lightgrid {
namespace {

struct CompareCommand {
  SceneOptions scene;
  DeviceOptions devices;
  TimingOptions timing;
  std::string output = "out/compare", json;
  std::vector<std::string> techniques = {"forward", "forward_plus"};
};

// The names and settings of -t, as split at its commas: "forward", "forward_plus:tile=32", "cull-test=aabb". What has
// a "=" but no name before a colon is one more setting of the name before it.
std::vector<Contestant> contestants_of(const std::vector<std::string>& items, const Settings& common) {
  std::vector<Contestant> contestants;
  for (const std::string& item : items) {
    const size_t colon = item.find(':');
    const bool setting_only = colon == std::string::npos && item.find('=') != std::string::npos;
    if (setting_only && !contestants.empty()) {
      apply_setting(contestants.back().settings, item);
      continue;
    }
    contestants.push_back({&find_technique(item.substr(0, colon)), common});
    if (colon != std::string::npos) apply_setting(contestants.back().settings, item.substr(colon + 1));
  }
  return contestants;
}

// On stderr: what was refused, which is no failure, and which gates failed. Returns whether any did.
bool tell_failures(const CompareReport& report) {
  const std::vector<std::string> names = row_names(report);
  bool failed = false;
  for (size_t i = 0; i < names.size(); ++i) {
    const RunResult& row = report.rows[i];
    if (!row.refused.empty()) log_warning("{}: refused: {}", names[i], row.refused);
    if (!row.refused.empty() || passes_gates(row)) continue;
    failed = true;
    fmt::print(stderr, "lightgrid: {}: {} lost and {} wrong pairs, {} NaN pixels; all must be 0\n", names[i], row.pairs->lost,
               row.pairs->wrong, row.nan_pixels);
  }
  return failed;
}

int compare(const CompareCommand& o) {
  const Settings common = chosen_settings(o.scene);
  const std::vector<Contestant> contestants = contestants_of(o.techniques, common);
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  const ChosenScene chosen = load_chosen_scene(o.scene);
  if (!o.json.empty()) check_output_file("--json", o.json);
  make_folder(o.output);
  Devices devices = open_devices(o.devices.device, backend);
  CompareOptions options{.frames = o.timing.frames, .warmup = o.timing.warmup};
  options.progress = progress_bar();
  const CompareReport report = compare_techniques(devices, chosen.scene, chosen.view, contestants, options);
  write_report(o.output, report);

  if (!o.json.empty()) write_json(o.json, json_text(report));
  if (o.json != "-") {
    fmt::print("{}\n", (std::filesystem::path(o.output) / "index.html").string());
    for (const std::string& figure : telling_figures(report)) fmt::print("  {}\n", figure);
  }
  return tell_failures(report) ? 1 : 0;
}

}  // namespace

void add_compare(CommandLine& line) {
  auto o = std::make_shared<CompareCommand>();
  Subcommand command = line.add("compare", "techniques side by side, as a report to look at", [o] { return compare(*o); });
  add_scene_options(command, o->scene);
  add_device_options(command, o->devices);
  add_timing_options(command, o->timing);
  command.list("-t,--techniques", o->techniques, "NAME[:KEY=VALUE[,KEY=VALUE…]] with commas between", ',');
  command.option("-o,--output", o->output, "folder of the report");
  command.option("--json", o->json, "results.json once more, into a file, - for stdout");
}

}  // namespace lightgrid
