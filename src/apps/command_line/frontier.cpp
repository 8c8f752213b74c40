// lightgrid frontier SCENE… -o DIR: what accuracy costs in time; frontier merge DIR… -o DIR; frontier export
// SCENE… -o DIR.
#include <fmt/format.h>
#include <malloc.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/timer.h"
#include "base/version.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/frontier_request.h"
#include "command_line/progress.h"
#include "frontier/answer.h"
#include "frontier/answer_steps.h"
#include "frontier/brute_force.h"
#include "frontier/measure.h"
#include "frontier/view_figures.h"
#include "measures/words.h"

extern char** environ;

namespace lightgrid::app {
using namespace lab;
namespace {

namespace fs = std::filesystem;

// The measures of a picture's error take vectors of some MB each, hundreds of them a picture. Freed ones are
// kept: given back to the system, each of their pages would be cleared anew.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
#endif
}

const std::vector<std::string> default_scenes = {"hall", "terrain", "spheres", "street"};

// Prints what a gate finds. Returns whether it failed.
bool failed_gate(const FrontierCommand& o, const FrontierAnswer& answer) {
  if (o.gate.empty()) return false;
  const GateResult result = held_against(to_json(answer), read_frontier_json(o.gate), o.gate);
  for (const std::string& note : result.told) log_info("gate {}: {}", o.gate, note);
  for (const std::string& fault : result.worse) fmt::print(stderr, "lightgrid: gate {}: {}\n", o.gate, fault);
  return !result.worse.empty();
}

// Points that lose lights, draw NaN or have wrong shadows that they say are exact fail; refused ones do not.
bool tell_losses(const FrontierAnswer& answer) {
  bool failed = false;
  const auto check = [&](const auto& p, const std::string& label) {
    if (p.external) {
      if (p.nan_pixels == 0) return;
      failed = true;
      fmt::print(stderr, "lightgrid: {} in {}: {} NaN pixels; all must be 0\n", label, p.point.scene,
                 p.nan_pixels);
      return;
    }
    const auto is_capped = [&](const char* key) { return !setting_in_force(p.point.settings, key).empty(); };
    const bool limited =
        find_technique(p.point.technique).limited_lists || is_capped("list_cap") || is_capped("view_cap");
    const uint64_t shadows = p.pairs.shadows ? p.pairs.shadows->faults() : 0;
    if ((p.pairs.lost == 0 || limited) && p.pairs.wrong == 0 && p.nan_pixels == 0 && shadows == 0) return;
    failed = true;
    fmt::print(stderr, "lightgrid: {} in {}: {} lost and {} wrong pairs, {} NaN pixels{}; all must be 0\n",
               label, p.point.scene, p.pairs.lost, p.pairs.wrong, p.nan_pixels,
               shadows > 0 ? fmt::format(", {} wrong shadows", shadows) : "");
  };
  for (const PointFigures& p : answer.points) check(p, p.point.label);
  for (const FrontierRecord& r : answer.part.records) {
    if (is_of_family(r)) check(r, label_in_series(r));
  }
  return failed;
}

int finish(const FrontierCommand& o, const std::vector<FrontierPart>& parts,
           const std::vector<fs::path>& pictures) {
  const FrontierAnswer answer = answer_of(parts);
  if (answer.points.empty() && answer.failures.empty())
    throw input_error("{}: no point was measured", o.output);
  write_answer(o.output, answer, pictures, size_t(o.page_mb) << 20);
  if (answer.points.empty() && answer.growth.empty()) {
    const Failure& first = answer.failures.front();
    throw machine_error("{}: no point ran; {} in {}: {}", o.output, first.point.label, first.point.scene,
                        first.why);
  }
  if (!o.json.empty()) write_json(o.json, json_text(to_json(answer)));
  if (o.json != "-") {
    fmt::print("{}\n", (fs::path(o.output) / "index.html").string());
    for (const std::string& sentence : answer.sentences) fmt::print("  {}\n", sentence);
  }
  const bool lost = tell_losses(answer), worse = failed_gate(o, answer);
  return lost || worse ? 1 : 0;
}

// A part of several has no answer of its own: in a folder that it shares it would replace that of all.
int finish_part(const FrontierPart& part, const fs::path& path) {
  fmt::print("{}\n", path.string());
  return tell_losses(answer_of({part})) ? 1 : 0;
}

int merge(const FrontierCommand& o) {
  if (o.scenes.size() < 2) throw input_error("merge: no folders; frontier merge DIR… -o DIR");
  std::vector<fs::path> folders(o.scenes.begin() + 1, o.scenes.end()), pictures;
  for (const fs::path& folder : folders) pictures.push_back(folder / "pictures");
  make_folder(o.output);
  return finish(o, read_parts(folders, [](const std::string& what) { log_info("{}", what); }), pictures);
}

// The arguments of this command, as they were given.
std::vector<std::string> own_arguments() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::vector<std::string> arguments;
  for (std::string argument; std::getline(file, argument, '\0');) arguments.push_back(argument);
  return arguments;
}

// Runs this command again as one of several processes. Throws Error(machine) if it cannot be started. Returns
// its exit status.
int run_process(int index, int count) {
  std::vector<std::string> arguments = own_arguments();
  arguments.push_back("--process");
  arguments.push_back(fmt::format("{}/{}", index, count));
  std::vector<char*> pointers;
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  pid_t child = 0;
  const int failure = posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, pointers.data(), environ);
  if (failure != 0)
    throw machine_error("process {} of {}: cannot be started: {}", index, count, strerror(failure));
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 3;
}

int frontier(FrontierCommand o);

// The rounds in several processes, one after the other; the answer is that of their part.
int frontier_in_processes(const FrontierCommand& o, const Shard& shard) {
  for (int i = 0; i < o.processes; ++i) {
    if (const int status = run_process(i, o.processes); status != 0) return status;
  }
  const fs::path path = part_path(o.output, shard.index, shard.count);
  const FrontierPart part = read_part(path, nullptr);
  return shard.count > 1 ? finish_part(part, path) : finish(o, {part}, {fs::path(o.output) / "pictures"});
}

int points_of_shard(size_t points, const Shard& shard) {
  int count = 0;
  for (size_t i = 0; i < points; ++i) count += in_shard(i, shard.index, shard.count);
  return count;
}

// The share of the budget: the first process measures the figures too.
double share_of_budget(const Shard& process) {
  if (process.count == 1) return 1;
  return process.index == 0 ? 0.5 : 0.5 / double(process.count - 1);
}

// Scenes, views and truths for other renderers.
int export_scenes(FrontierCommand o) {
  o.scenes.erase(o.scenes.begin());
  if (o.scenes.empty()) throw input_error("export: no scene; frontier export SCENE… -o DIR");
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  const std::vector<bool> casts = check_request(o, {});
  make_folder(o.output);
  Renderer renderer(o.devices.device, backend);
  FrontierJob job = job_of(o, renderer, Shard());
  const auto bar = progress_bar();
  for (size_t i = 0; i < o.scenes.size(); ++i) {
    const std::string& scene = o.scenes[i];
    job.progress = [&](double done, const std::string& step) {
      bar((double(i) + done) / double(o.scenes.size()), scene + ": " + step);
    };
    ask(job, request_of_scene(o, casts[i], job.common, renderer.gl != nullptr), Shard());
    const fs::path folder = fs::path(o.output) / folder_of_scene(o, i);
    make_folder(folder);
    export_with_truths(renderer, choice_of(o, scene), job, folder);
    fmt::print("{}\n", (folder / "views.json").string());
  }
  bar(1, "");
  return 0;
}

int frontier(FrontierCommand o) {
  if (!o.scenes.empty() && o.scenes.front() == "merge") return merge(o);
  if (!o.scenes.empty() && o.scenes.front() == "export") return export_scenes(std::move(o));
  if (o.scenes.empty()) o.scenes = o.families ? std::vector<std::string>{"terrain"} : default_scenes;
  const Timer timer;
  const WarningCollector warnings;
  const Shard shard = parse_shard(o.shard);
  if (shard.count > 1 && !(o.gate.empty() && o.json.empty())) {
    throw input_error("shard {}: a part has no answer; give {} to frontier merge", o.shard,
                      o.gate.empty() ? "--json" : "--gate");
  }
  const Shard process = o.process.empty() ? Shard() : parse_shard(o.process, "process");
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  chosen_points(o.techniques, o.vary, chosen_settings(o.scene), true);
  baseline_point(chosen_settings(o.scene), true, o.baseline);
  const Externals externals = read_external_renderers(o.external, o.scenes);
  const std::vector<bool> casts = check_request(o, externals);
  make_folder(o.output);
  if (o.processes > 1 && o.process.empty()) return frontier_in_processes(o, shard);
  keep_freed_memory();
  Renderer renderer(o.devices.device, backend);
  FrontierJob job = job_of(o, renderer, shard);
  std::vector<SceneRequest> of_scenes;
  for (size_t i = 0; i < casts.size(); ++i) {
    of_scenes.push_back(request_of_scene(o, casts[i], job.common, renderer.gl != nullptr));
    add_external_points(externals, o.scenes[i], of_scenes.back());
  }
  FrontierPart part;
  part.request = request_of(o, points_of(o, job.common, renderer.gl != nullptr), of_scenes, externals);
  part.commit = commit_of_build();
  part.seed = o.scene.seed;
  part.shard = shard.index;
  part.shards = shard.count;
  part.baseline = job.baseline.label;
  part.keep = o.keep;
  part.half_width = job.half_width;
  for (size_t i = 0; i < o.scenes.size() && !o.families; ++i)
    part.points_asked[o.scenes[i]] = points_of_shard(of_scenes[i].points.size(), shard);
  part.machine = machine_of(renderer);
  const fs::path path = part_path(o.output, shard.index, shard.count);
  RecordFile file(path, part, job.notice);

  job.process = process.index;
  job.processes = process.count;
  job.growth = job.growth && process.index + 1 == process.count;

  const auto bar = progress_bar();
  const double budget_s = o.budget * 60.0 * share_of_budget(process);
  double sequences_s = 0;
  size_t measured = 0;
  for (size_t i = 0; i < o.scenes.size(); ++i) {
    const double left = budget_s + sequences_s - timer.elapsed_ms() / 1000;
    if (left <= 0) {
      log_warning("budget {}: no time left for {}", o.budget, o.scenes[i]);
      continue;
    }
    job.seconds = left / double(o.scenes.size() - i);
    const double done = 1 - left / budget_s, share = job.seconds / budget_s;
    job.progress = [&](double part_done, const std::string& step) {
      bar(done + part_done * share, o.scenes[i] + ": " + step);
    };
    ask(job, of_scenes[i], shard);
    job.exports = fs::path(o.output) / "external" / folder_of_scene(o, i);
    sequences_s += measure_scene(renderer, choice_of(o, o.scenes[i]), job, file);
    ++measured;
  }
  if (measured == 0) throw input_error("budget {}: too short for one point", o.budget);
  bar(1, "");
  if (process.index + 1 < process.count) return 0;
  file.finish(load_average(), warnings.warnings());
  if (process.count > 1) return 0;
  return shard.count > 1 ? finish_part(file.part(), path) : finish(o, {file.part()}, {job.pictures});
}

}  // namespace

void add_frontier(CommandLine& line) {
  auto o = std::make_shared<FrontierCommand>();
  o->scene.size = "640x360";
  Subcommand command = line.add("frontier", "what accuracy costs in time, over settings and scenes",
                                [o] { return frontier(*o); });
  command.list("scene", o->scenes,
               "scenes as for compare (default: hall, terrain, spheres, street); or merge DIR…: joins the "
               "parts of a sweep; or export SCENE…: writes scenes for another renderer");
  command.option("--size", o->scene.size, "image size, WxH");
  command.option("--lights", o->scene.lights, "scatter N lights; with --lights-file, its first N", 0,
                 max_lights);
  add_view_options(command, o->scene);
  add_exposure_option(command, o->scene);
  command.option("--camera-path", o->scene.camera_path,
                 "views from turn:N, dolly:N or a JSON file of keys (default: a turn)");
  command.option("--views", o->views, "maximum number of views per scene", 1, 1000);
  add_device_options(command, o->devices);
  command.list("-t,--technique,--techniques", o->techniques,
               "NAME[:KEY=VALUE[,KEY=VALUE…]], separated by commas (default: a star of settings around each)",
               ',');
  command.list(
      "--vary", o->vary,
      "KEY=VALUE,VALUE,…: each technique that reads KEY with each value, one key at a time; may be repeated");
  command.list(
      "--external", o->external,
      "FILE: another renderer that takes part, as a command or as pictures and times; may be repeated");
  command.option("--baseline", o->baseline,
                 "NAME[:KEY=VALUE…]: the point to which times are relative (default: forward_plus; without "
                 "OpenGL visibility)");
  command.option("--truth", o->truth,
                 "the picture with which others are compared: lights without ranges (infinite), with their "
                 "own, or with their own and averaged over each pixel's area (default: infinite; if lights "
                 "cast shadows, own; with several samples, area)");
  command.option(
      "--rounds", o->rounds,
      "maximum number of rounds, of two times per point and view; fewer if the intervals are narrow "
      "earlier",
      1, 1000);
  command.option("--half-width", o->half_width,
                 "percentage of a relative time: rounds end when half of each 95 % interval is at most this");
  add_keep_option(command, o->keep);
  command.flag("--no-growth", o->no_growth, "does not measure how times grow with lights, pixels and ranges");
  command.flag(
      "--sequences", o->sequences,
      "also measures flicker over 64 frames: still camera, dolly, moving lights; in addition to the budget");
  command.flag("--families", o->families,
               "measures families of lights instead: 10^2 to 10^6 scattered lights at an equal overlap, and "
               "overlaps of 1 to 1,000 lights per pixel with an equal number (--lights, default 10,000)");
  command.option("--budget", o->budget, "minutes that measuring may take", 1, 100000);
  command.option("--gate", o->gate,
                 "an earlier frontier.json: status 1 if an error grew, a light is lost, a time is worse or a "
                 "control fails");
  command.option("--processes", o->processes,
                 "number of processes, one after the other, that share the rounds: with 5 or more, intervals "
                 "include differences between processes",
                 1, 100);
  command.option("--process", o->process,
                 "I/N: only the I-th of N such processes; the last one completes the part");
  command.option("--shard", o->shard,
                 "I/N: every N-th point from the I-th on, for a sweep of several processes");
  command.option("-o,--output", o->output, "folder of the parts and the answer");
  command.option("--page-mb", o->page_mb, "limit of pictures in the page in MiB", 1, 1000);
  command.option("--json", o->json, "frontier.json also into a file, - for stdout");
}

}  // namespace lightgrid::app
