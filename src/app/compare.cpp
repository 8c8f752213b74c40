// lightgrid compare SCENE… -t A,B,… -o DIR: images, results.json and index.html.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "app/progress.h"
#include "base/error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "compare/compare.h"
#include "report/report.h"
#include "session/contestants.h"
#include "session/loaded_views.h"
#include "results/words.h"

namespace lightgrid {
namespace {

struct CompareCommand {
  SceneChoice scene;  // shared by all views
  std::vector<std::string> scenes = {"hall"}, sizes = {"1280x720"}, lights;
  DeviceOptions devices;
  TimingOptions timing;
  std::string output = "out/compare", json;
  std::vector<std::string> techniques;  // empty: default_techniques, or those without OpenGL
  std::vector<std::string> compare;
  std::string reference = "auto";
  int page_mb = 30;
  bool flip = false;
};

const std::vector<std::string> default_techniques = {"forward", "forward_plus", "visibility"};
const std::vector<std::string> techniques_without_opengl = {"visibility:lights=all", "visibility"};

int parse_lights(const std::string& text) {
  int count = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failure != std::errc() || end != text.data() + text.size() || count < 0 || count > most_lights) {
    throw input_error("--lights {}: not a number from 0 to {}", text, most_lights);
  }
  return count;
}

ReferencePixels parse_reference(const std::string& text) {
  if (text == "auto") return ReferencePixels::automatic;
  if (text == "full") return ReferencePixels::full;
  if (text == "sampled") return ReferencePixels::sampled;
  throw input_error("--reference {}: not full, sampled or auto", text);
}

// Every scene at every size with every number of lights.
std::vector<SceneChoice> chosen_views(const CompareCommand& o) {
  std::vector<int> counts;
  for (const std::string& text : o.lights) counts.push_back(parse_lights(text));
  if (counts.empty()) counts.push_back(-1);
  std::vector<SceneChoice> views;
  for (const std::string& scene : o.scenes) {
    for (const std::string& size : o.sizes) {
      parse_size(size);
      for (const int lights : counts) {
        SceneChoice& view = views.emplace_back(o.scene);
        view.scene = scene, view.size = size, view.lights = lights;
      }
    }
  }
  return views;
}

// A view's cost relative to the others, roughly: pixels, and pixels times lights for techniques without
// lists.
double cost_of(const LoadedView& view) {
  return double(view.view.width) * view.view.height * double(64 + view.lights.size());
}

// Runs the views in turn, with one progress bar for all; calls found() with each report.
template <typename Found>
void run_views(Renderer& devices, const std::vector<LoadedView>& views,
               const std::vector<Contestant>& contestants, const CompareCommand& o, const Found& found) {
  double total = 0, before = 0;
  for (const LoadedView& view : views) total += cost_of(view);
  const auto bar = progress_bar();
  for (size_t i = 0; i < views.size(); ++i) {
    const LoadedView& view = views[i];
    CompareOptions options{.frames = o.timing.frames,
                           .warmup = o.timing.warmup,
                           .reference = parse_reference(o.reference),
                           .seed = o.scene.seed,
                           .flip = o.flip,
                           .all_may_refuse = views.size() > 1};
    const double cost = cost_of(view);
    const std::string which =
        views.size() > 1 ? fmt::format("{}/{} {}: ", i + 1, views.size(), view.scene->name) : "";
    options.progress = [&](double done, const std::string& step) {
      bar((before + done * cost) / total, which + step);
    };
    options.notice = [&](const std::string& what) { log_info("{}{}", which, what); };
    Scene& scene = view.with_lights();
    options.path = chosen_path(scene, view.view, o.scene);
    if (!options.path.empty()) options.advance = chosen_motion(scene, o.scene);
    found(compare_techniques(devices, scene, view.view, contestants, options));
    before += cost;
  }
}

// Prints on stderr what was refused, which is no failure, and which gates failed. Returns whether any did.
bool tell_failures(const CompareReport& report, const std::string& view) {
  const std::vector<std::string> names = row_names(report);
  bool failed = false;
  for (size_t i = 0; i < names.size(); ++i) {
    const RunResult& row = report.rows[i];
    if (!row.refused.empty()) log_warning("{}{}: refused: {}", view, names[i], row.refused);
    if (!row.refused.empty() || passes_gates(row)) continue;
    failed = true;
    fmt::print(stderr, "lightgrid: {}{}: {} lost and {} wrong pairs, {} NaN pixels; all must be 0\n", view,
               names[i], row.pairs->lost, row.pairs->wrong, row.nan_pixels);
  }
  return failed;
}

std::string page_path(const CompareCommand& o) {
  return (std::filesystem::path(o.output) / "index.html").string();
}

int compare_one(const CompareCommand& o, Renderer& devices, std::vector<LoadedView> views,
                const std::vector<Contestant>& contestants) {
  CompareReport report;
  run_views(devices, views, contestants, o, [&](CompareReport found) { report = std::move(found); });
  views.clear();  // pictures and pages are made without the scene
  write_report(o.output, report);
  if (!o.json.empty()) write_json(o.json, json_text(report));
  if (o.json != "-") {
    fmt::print("{}\n", page_path(o));
    for (const std::string& figure : telling_figures(report)) fmt::print("  {}\n", figure);
  }
  return tell_failures(report, "") ? 1 : 0;
}

int compare_several(const CompareCommand& o, Renderer& devices, const std::vector<LoadedView>& views,
                    const std::vector<Contestant>& contestants) {
  ViewsReport report(o.output, views.size(), size_t(o.page_mb) << 20);
  bool failed = false;
  run_views(devices, views, contestants, o, [&](CompareReport found) {
    const ReportView& view = report.add(std::move(found));
    failed |= tell_failures(view.report, view_in_words(view.report) + ": ");
  });
  report.write();
  if (!o.json.empty()) write_json(o.json, report.json_text());
  if (o.json != "-") {
    fmt::print("{}\n", page_path(o));
    for (const std::string& sentence : report.sentences()) fmt::print("  {}\n", sentence);
  }
  return failed ? 1 : 0;
}

// Those given or, if none is, those that this machine can run: what is left out is reported on stderr. Throws
// Error(machine) if one that is given needs OpenGL and there is none.
std::vector<Contestant> runnable(const CompareCommand& o, std::vector<Contestant> contestants,
                                 const Renderer& devices) {
  if (devices.gl) return contestants;
  if (!o.techniques.empty()) {
    if (std::ranges::any_of(contestants, [](const Contestant& c) {
          return draws_with_opengl(c.technique->needs, c.settings);
        }))
      devices.require_gl();
    return contestants;
  }
  log_warning(
      "{}; left out, since they draw with it: forward, forward_plus. The reference is visibility:lights=all",
      devices.why_no_gl);
  return chosen_contestants(techniques_without_opengl, chosen_settings(o.scene), o.compare);
}

int compare(const CompareCommand& o) {
  const std::vector<Contestant> given = chosen_contestants(
      o.techniques.empty() ? default_techniques : o.techniques, chosen_settings(o.scene), o.compare);
  parse_reference(o.reference);
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  std::vector<LoadedView> views = load_views(chosen_views(o));
  if (!o.json.empty()) check_output_file("--json", o.json);
  make_folder(o.output);
  Renderer devices(o.devices.device, backend);
  const std::vector<Contestant> contestants = runnable(o, given, devices);
  return views.size() == 1 ? compare_one(o, devices, std::move(views), contestants)
                           : compare_several(o, devices, views, contestants);
}

}  // namespace

void add_compare(CommandLine& line) {
  auto o = std::make_shared<CompareCommand>();
  Subcommand command =
      line.add("compare", "techniques side by side, as a report", [o] { return compare(*o); });
  command.list("scene", o->scenes, "one or more: .gltf or .glb files, or built-in scenes");
  command.list("--size", o->sizes, "image size, WxH, or several separated by commas", ',');
  command.list("--lights", o->lights,
               "scatter N lights; with --lights-file, its first N; or several separated by commas", ',');
  add_view_options(command, o->scene);
  add_path_option(command, o->scene);
  add_device_options(command, o->devices);
  add_timing_options(command, o->timing);
  command.list("-t,--techniques", o->techniques,
               "NAME[:KEY=VALUE[,KEY=VALUE…]], separated by commas; names are " + technique_names() +
                   fmt::format(" (default: {})", fmt::join(default_techniques, ",")),
               ',');
  command.list("--compare", o->compare,
               "KEY=VALUE,VALUE,…: each technique that reads KEY, with each value; may be repeated");
  command.option("--reference", o->reference,
                 "pixels of the brute-force image: full, sampled, or auto (sampled past a minute)");
  command.flag("--flip", o->flip, "measure HDR-FLIP too, which takes seconds a row");
  command.option("-o,--output", o->output, "folder of the report");
  command.option("--page-mb", o->page_mb, "with several views: limit of pictures in the page in MiB", 1,
                 1000);
  command.option("--json", o->json, "results.json also into a file, - for stdout");
}

}  // namespace lightgrid
