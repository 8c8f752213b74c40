// lightgrid bench: the culling pipeline's kernels against the machine's limits.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/write_file.h"
#include "bench/bench.h"
#include "bench/bench_page.h"
#include "bench/rows.h"
#include "bench/tune.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "compare/contestants.h"
#include "frames/capture.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct BenchCommand {
  SceneChoice scene{.scene = ""};
  DeviceOptions devices;
  std::string filter, json, html, write_frames;
  std::vector<std::string> replay, compare;
  TimingOptions timing{30, 3};
  bool tune = false;
};

std::vector<BenchContestant> contestants_of(const BenchCommand& o) {
  Settings base;
  for (const std::string& assignment : o.scene.set) apply_setting(base, assignment);
  return culling_contestants(base, o.compare, 64);
}

void check_frame_folder(const std::string& folder) {
  std::error_code unreadable;
  for (const char* file : {"view.json", "lights.json", "depth.f32"}) {
    if (!std::filesystem::is_regular_file(std::filesystem::path(folder) / file, unreadable)) {
      throw input_error("--replay {}: has no {}", folder, file);
    }
  }
}

std::vector<BenchCase> replayed_cases(const BenchCommand& o) {
  std::vector<BenchCase> cases;
  for (const std::string& folder : o.replay) {
    check_frame_folder(folder);
    const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
    cases.push_back({(path.has_filename() ? path : path.parent_path()).filename().string(), {}, [folder] {
                       return read_frame(folder);
                     }});
  }
  return cases;
}

// Frames of a scene, along its camera path or at rest.
class SceneFrames {
 public:
  SceneFrames(const SceneChoice& choice, const DeviceOptions& devices)
      : choice_(with_scene(choice, devices)),
        settings_(chosen_settings(choice_)),
        chosen_(load_chosen_scene(choice_)),
        path_(chosen_path(chosen_.scene, chosen_.view, choice_)),
        advance_(chosen_motion(chosen_.scene, choice_)),
        renderer_(devices.device, parse_gl_backend(devices.gl)),
        capture_(renderer_, chosen_.scene, chosen_.view, settings_, technique_or_default("", renderer_)) {}

  ClDevice& device() { return *renderer_.cl; }

  // They refer to this object, and draw their frames when they run.
  std::vector<BenchCase> cases() {
    std::vector<BenchCase> cases;
    const std::string& name = chosen_.scene.name;
    if (path_.empty()) cases.push_back({name, {}, [this] { return capture_.frame(chosen_.view); }});
    for (size_t i = 0; i < path_.size(); ++i)
      cases.push_back({fmt::format("{}-{:04}", name, i), {}, [this, i] { return frame(i); }});
    return cases;
  }

 private:
  static SceneChoice with_scene(SceneChoice choice, const DeviceOptions& devices) {
    choice.device = devices.device;
    if (choice.scene.empty()) choice.scene = SceneChoice().scene;
    return choice;
  }

  CapturedFrame frame(size_t i) { return capture_.frame(path_[i], advance_ ? advance_(i) : SceneChanges()); }

  SceneChoice choice_;
  Settings settings_;
  ChosenScene chosen_;
  std::vector<View> path_;
  SceneMotion advance_;
  Renderer renderer_;
  SceneCapture capture_;
};

bool chooses_scene(const SceneChoice& o) {
  const SceneChoice plain;
  return !o.scene.empty() || !o.camera_path.empty() || !o.camera.empty() || !o.lights_file.empty() ||
         !o.light_radius.empty() || o.virtual_lights > 0 || !o.ambient.empty() || !o.environment.empty() ||
         !o.shadows.empty() || !o.time.empty() || o.lights >= 0 || o.size != plain.size ||
         o.seed != plain.seed || o.light_motion != plain.light_motion;
}

// Null: none was chosen.
std::unique_ptr<SceneFrames> chosen_frames(const BenchCommand& o) {
  if (!chooses_scene(o.scene)) return nullptr;
  if (!o.replay.empty())
    throw input_error("--replay {}: frames come from files or from a scene, not from both", o.replay[0]);
  if (o.tune) throw input_error("--tune: has frames of its own, and takes no scene");
  return std::make_unique<SceneFrames>(o.scene, o.devices);
}

bool gives_tile(const std::vector<std::string>& assignments) {
  return std::any_of(assignments.begin(), assignments.end(),
                     [](const std::string& a) { return a.starts_with("tile="); });
}

int tune(const BenchCommand& o) {
  if (tuned_sizes_file().empty()) throw input_error("--tune: LIGHTGRID_TUNED=off leaves no file to write");
  ClDevice device(o.devices.device);
  TuneOptions options{o.timing.frames, o.timing.warmup, {}};
  options.step = progress_bar();
  const TuneResult result = tune_kernels(device, options);
  write_tuned_sizes(device.info(), result.best);
  nlohmann::ordered_json json = {{"device", device.info().name},
                                 {"best", result.best},
                                 {"file", tuned_sizes_file().string()},
                                 {"trials", nlohmann::ordered_json::array()}};
  for (const TuneTrial& t : result.trials) {
    json["trials"].push_back({{"setting", t.assignment}, {"ratio", t.ratio}, {"failure", t.failure}});
    if (o.json != "-")
      fmt::print("{:<28}{}\n", t.assignment,
                 t.failure.empty() ? fmt::format("x {:.2f}", t.ratio) : t.failure);
  }
  if (o.json != "-") fmt::print("stored in {}\n", tuned_sizes_file().string());
  if (!o.json.empty()) write_json(o.json, json.dump(1));
  return 0;
}

int bench(const BenchCommand& o) {
  RowFilter(o.filter);  // reports a wrong filter before the work
  check_output_files({{"--json", o.json}, {"--html", o.html}});
  const std::unique_ptr<SceneFrames> frames = chosen_frames(o);
  if (o.tune) return tune(o);
  BenchOptions options{.cases = frames             ? frames->cases()
                                : o.replay.empty() ? standard_cases()
                                                   : replayed_cases(o),
                       .contestants = contestants_of(o),
                       .filter = o.filter};
  options.own_tile = !gives_tile(o.scene.set) && !gives_tile(o.compare);
  options.frames = o.timing.frames;
  options.warmup = o.timing.warmup;
  options.step = progress_bar();
  if (!o.write_frames.empty()) {
    write_frames(o.write_frames, options);
    return 0;
  }
  const bool table = o.json != "-";
  if (table) {
    options.found = [](const std::vector<BenchRow>& rows) {
      for (const BenchRow& row : rows) std::fputs(table_line(row).c_str(), stdout);
      std::fflush(stdout);
    };
  }
  std::optional<ClDevice> own_device;
  if (!frames) own_device.emplace(o.devices.device);
  ClDevice& device = frames ? frames->device() : *own_device;
  for (BenchContestant& c : options.contestants)
    c.settings = with_tuned(c.settings, read_tuned_sizes(device.info()));
  if (table) fmt::print("{}, {}\n{}", device.info().name, device.info().driver, table_head());
  const BenchReport report = run_bench(device, options);
  if (table) fmt::print("{}", slowest_kernel_text(report.rows));
  if (!o.json.empty()) write_json(o.json, to_json(report).dump(1));
  if (!o.html.empty()) write_file(o.html, bench_page(report));
  return 0;
}

}  // namespace

void add_bench(CommandLine& line) {
  auto o = std::make_shared<BenchCommand>();
  Subcommand command = line.add("bench", "culling and rasteriser kernels against the machine's limits",
                                [o] { return bench(*o); });
  command.option("--filter", o->filter, "only rows whose \"CASE/ROW\" matches this regular expression");
  add_scene_options(command, o->scene);
  add_path_option(command, o->scene);
  add_device_options(command, o->devices);
  command.list("--replay", o->replay,
               "a captured frame's folder instead of the standard frames; may be repeated");
  command.option("--write-frames", o->write_frames,
                 "writes the frames of the cases into this folder, and measures nothing");
  command.flag("--tune", o->tune,
               "finds the fastest kernel shape and sizes, and stores them for this device");
  command.list("--compare", o->compare,
               "KEY=VALUE,VALUE,…: run in turn, with ratios to the first; may be repeated");
  add_timing_options(command, o->timing);
  command.option("--json", o->json, "as JSON into a file, - for stdout");
  command.option("--html", o->html, "a page of the results, into a file");
}

}  // namespace lightgrid::app
