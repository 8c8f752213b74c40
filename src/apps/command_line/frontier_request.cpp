#include "command_line/frontier_request.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "frontier/answer.h"
#include "frontier/brute_force.h"
#include "frontier/view_figures.h"
#include "measures/words.h"
#include "plan/settings/samples.h"

namespace lightgrid::app {
using namespace lab;

namespace fs = std::filesystem;

Shard parse_shard(const std::string& text, const char* what) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = slash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!slash || count.ec != std::errc() || count.ptr != end || shard.count < 1 || shard.count > 100000 ||
      shard.index < 0 || shard.index >= shard.count) {
    throw input_error("{} {}: not I/N with I from 0 to N - 1", what, text);
  }
  return shard;
}

SceneChoice choice_of(const FrontierCommand& o, const std::string& scene) {
  SceneChoice choice = o.scene;
  choice.scene = scene;
  choice.device = o.devices.device;
  return choice;
}

namespace {

// Empty: as the points and the scene's lights call for.
enum class TruthChoice { called_for, infinite, own, area };
TruthChoice parse_truth(const std::string& text) {
  if (text.empty()) return TruthChoice::called_for;
  if (text == "infinite") return TruthChoice::infinite;
  if (text == "own") return TruthChoice::own;
  if (text == "area") return TruthChoice::area;
  throw input_error("truth {}: neither infinite, own nor area", text);
}

// Families scatter lights of their own, in one process.
void check_families(const FrontierCommand& o) {
  if (!o.families) return;
  const SceneChoice& s = o.scene;
  for (const auto& [name, given] : {std::pair{"lights-file", !s.lights_file.empty()},
                                    {"light-radius", !s.light_radius.empty()},
                                    {"shadows", !s.shadows.empty()},
                                    {"virtual-lights", s.virtual_lights > 0},
                                    {"camera-path", !s.camera_path.empty()},
                                    {"truth", !o.truth.empty()},
                                    {"shard", parse_shard(o.shard).count > 1},
                                    {"processes", o.processes > 1},
                                    {"sequences", o.sequences},
                                    {"external", !o.external.empty()}}) {
    if (given) throw input_error("families: {} does not apply to families of lights", name);
  }
}

}  // namespace

std::vector<ChosenPoint> points_of(const FrontierCommand& o, const Settings& common, bool opengl,
                                   const std::optional<FrontierTruth>& shadows) {
  if (o.families && o.techniques.empty() && o.vary.empty()) return family_points(common, opengl);
  return chosen_points(o.techniques, o.vary, common, opengl, shadows);
}

SceneRequest request_of_scene(const FrontierCommand& o, bool casts, const Settings& common, bool opengl) {
  const TruthChoice choice = parse_truth(o.truth);
  const auto own =
      choice == TruthChoice::called_for ? std::optional<bool>() : choice != TruthChoice::infinite;
  SceneRequest request{{}, chosen_truth(common, casts, own), casts};
  const auto shadows = casts ? std::optional(request.truth) : std::nullopt;
  request.points = points_of(o, common, opengl, shadows);
  const auto has_samples = [](const ChosenPoint& p) { return p.contestant.settings[setting::samples] > 1; };
  const bool areas = choice == TruthChoice::area ||
                     (choice == TruthChoice::called_for && std::ranges::any_of(request.points, has_samples));
  request.truth = chosen_truth(common, casts, own, areas);
  return request;
}

void add_external_points(const Externals& externals, const std::string& scene, SceneRequest& request) {
  for (const auto& renderer : externals) {
    if (renderer->takes_part(scene)) request.points.push_back(external_point(renderer));
  }
}

fs::path folder_of_scene(const FrontierCommand& o, size_t scene) {
  const auto name = [&](size_t i) { return scene_in_words(o.scenes[i]); };
  size_t same = 0;
  for (size_t i = 0; i < scene; ++i) same += name(i) == name(scene);
  return same ? fmt::format("{}-{}", name(scene), same + 1) : name(scene);
}

std::string request_of(const FrontierCommand& o, const std::vector<ChosenPoint>& points,
                       const std::vector<SceneRequest>& of_scenes, const Externals& externals) {
  const SceneChoice& s = o.scene;
  nlohmann::json request = {{"scenes", o.scenes},
                            {"size", s.size},
                            {"camera", s.camera},
                            {"camera_path", s.camera_path},
                            {"time", s.time},
                            {"lights", s.lights},
                            {"lights_file", s.lights_file},
                            {"light_radius", s.light_radius},
                            {"seed", s.seed},
                            {"views", o.views}};
  if (!s.ambient.empty()) request["ambient"] = s.ambient;
  if (!s.environment.empty()) request["environment"] = s.environment;
  if (s.virtual_lights > 0) request["virtual"] = {s.virtual_lights, s.virtual_from, s.virtual_nearest};
  if (!s.shadows.empty()) request["shadows"] = s.shadows;
  if (!s.exposure.empty()) request["exposure"] = s.exposure;
  for (const ChosenPoint& point : points) {
    request["points"].push_back({point.contestant.technique->name,
                                 settings_of(*point.contestant.technique, point.contestant.settings),
                                 point.frames});
  }
  for (const auto& renderer : externals)
    request["external"].push_back({renderer->label(), renderer->content});
  // Lights of a path's file may cast in one sweep and not in the next.
  if (!o.truth.empty()) request["truth"] = o.truth;
  if (o.sequences) request["sequences"] = true;
  if (o.families) request["families"] = true;
  request["keep"] = o.keep;
  for (size_t i = 0; i < of_scenes.size(); ++i) {
    if (!of_scenes[i].casts) continue;
    request["casting"].push_back(i);
    for (const ChosenPoint& point : of_scenes[i].points) request["casting"].push_back(point.label);
  }
  // A path may hold bytes that are not UTF-8.
  return content_hash(request.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

static double parse_half_width(const std::string& text) {
  const std::optional<double> percent = parse_number<double>(text);
  if (!percent || !(*percent > 0 && *percent <= 100))
    throw input_error("half-width {}: not a number of per cent above 0, at most 100", text);
  return *percent / 100;
}

std::vector<bool> check_request(const FrontierCommand& o, const Externals& externals) {
  parse_half_width(o.half_width);
  parse_truth(o.truth);
  check_families(o);
  parse_kept(o.keep, o.scene);
  if (!o.gate.empty()) read_frontier_json(o.gate);
  if (!o.json.empty()) check_output_file("--json", o.json);
  std::vector<bool> casts;
  for (const std::string& scene : o.scenes) {
    const ChosenScene chosen = load_chosen_scene(choice_of(o, scene));
    casts.push_back(std::ranges::any_of(chosen.scene.lights, &Light::casts_shadow));
    for (const auto& renderer : externals) {
      check_external_frames(*renderer, scene, chosen.scene,
                            frontier_views(chosen.scene, chosen.view, choice_of(o, scene), o.views));
    }
  }
  return casts;
}

FrontierJob job_of(const FrontierCommand& o, const Renderer& renderer, const Shard& shard) {
  FrontierJob job;
  job.common = chosen_settings(o.scene);
  if (!job.common.given(setting::samples)) job.common = with_samples(std::move(job.common), 1);
  job.baseline = baseline_point(job.common, renderer.gl != nullptr, o.baseline);
  job.views = o.views;
  job.seed = o.scene.seed;
  job.growth = shard.index == 0 && !o.no_growth;
  job.keep = parse_kept(o.keep, o.scene);
  job.sequences = o.sequences;
  if (o.families) job.families.emplace();
  if (o.families && o.scene.lights >= 0) job.families->number = o.scene.lights;
  job.max_rounds_per_point = o.rounds;
  job.half_width = parse_half_width(o.half_width);
  job.min_rounds_per_point = std::min(job.min_rounds_per_point, o.rounds);
  job.pictures = fs::path(o.output) / "pictures";
  job.notice = [](const std::string& what) { log_info("{}", what); };
  return job;
}

void ask(FrontierJob& job, const SceneRequest& request, const Shard& shard) {
  job.points.clear();
  for (size_t i = 0; i < request.points.size(); ++i) {
    if (in_shard(i, shard.index, shard.count)) job.points.push_back(request.points[i]);
  }
  job.truth = request.truth;
}

}  // namespace lightgrid::app
