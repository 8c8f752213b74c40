// lightgrid which SCENE: the fastest technique and settings within an error, by a race of half a minute.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/timer.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "frontier/brute_force.h"
#include "measures/results.h"
#include "plan/settings/samples.h"
#include "which/which.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct WhichCommand {
  SceneChoice scene;
  DeviceOptions devices;
  std::vector<std::string> techniques;
  std::string error = "0.05", output, json;
  int seconds = 30;
  bool changes = false;
};

double parse_error(const std::string& text) {
  const std::optional<double> flip = parse_number<double>(text);
  if (!flip || !(*flip >= 0 && *flip <= 1)) throw input_error("error {}: not a FLIP from 0 to 1", text);
  return *flip;
}

WhichJob job_of(const WhichCommand& o, bool opengl) {
  WhichJob job;
  job.common = chosen_settings(o.scene);
  if (!job.common.given(setting::samples)) job.common = with_samples(std::move(job.common), 1);
  const ChosenScene chosen = load_chosen_scene(o.scene);
  const bool casts = std::ranges::any_of(chosen.scene.lights, &Light::casts_shadow);
  job.truth = chosen_truth(job.common, casts, true);
  job.points =
      which_points(o.techniques, job.common, opengl, casts ? std::optional(job.truth) : std::nullopt);
  job.max_flip = parse_error(o.error);
  job.seconds = o.seconds;
  job.seed = o.scene.seed;
  return job;
}

std::string in_words(const WhichChange& change, const WhichAnswer& before) {
  const auto label = [](const WhichAnswer& a) {
    return a.choice ? a.points[*a.choice].point.label : std::string();
  };
  const bool same = label(change.answer) == label(before);
  return fmt::format("{}: {}: {}", change.what, same ? "the same" : "another", lab::in_words(change.answer));
}

int which(WhichCommand o) {
  const Timer timer;
  o.scene.device = o.devices.device;
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  parse_error(o.error);
  check_output_files({{"--json", o.json}, {"--output", o.output}});
  check_choice(o.scene);
  which_points(o.techniques, chosen_settings(o.scene), true, {});
  Renderer renderer(o.devices.device, backend);
  WhichJob job = job_of(o, renderer.gl != nullptr);
  const auto bar = progress_bar();
  job.progress = bar;
  job.before_s = timer.elapsed_ms() / 1000;
  const WhichAnswer answer = lab::which(renderer, o.scene, job);
  std::vector<WhichChange> changes;
  if (o.changes) changes = changes_of(renderer, o.scene, job, answer);
  bar(1, "");
  nlohmann::ordered_json json = to_json(answer);
  for (const WhichChange& change : changes)
    json["changes"].push_back({{"what", change.what}, {"answer", to_json(change.answer)}});
  if (!o.json.empty()) write_json(o.json, json_text(json));
  if (!o.output.empty()) write_json(o.output, which_page(answer, changes));
  if (o.json == "-") return answer.choice ? 0 : 1;
  fmt::print("{}\n", lab::in_words(answer));
  for (const WhichChange& change : changes) fmt::print("  {}\n", in_words(change, answer));
  return answer.choice ? 0 : 1;
}

}  // namespace

void add_which(CommandLine& line) {
  auto o = std::make_shared<WhichCommand>();
  o->scene.size = "640x360";
  Subcommand command = line.add("which", "the fastest technique and settings for a view, by a race",
                                [o] { return which(*o); });
  add_scene_options(command, o->scene);
  add_exposure_option(command, o->scene);
  add_device_options(command, o->devices);
  command.list("-t,--technique,--techniques", o->techniques,
               "NAME[:KEY=VALUE[,KEY=VALUE…]], separated by commas (default: a star of settings around each)",
               ',');
  command.option("--error", o->error,
                 "largest mean FLIP of the picture, relative to every light with the ranges of the settings");
  command.option("--seconds", o->seconds, "seconds that the race may take, with loading and compiling", 1,
                 100000);
  command.flag(
      "--changes", o->changes,
      "also races the fastest points with 2 and 4 times the lights and at twice the size; each takes "
      "--seconds again");
  command.option("-o,--output", o->output, "a page with all points, as an HTML file");
  command.option("--json", o->json, "the answer as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
