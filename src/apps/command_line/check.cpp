// lightgrid check --engine NAME SCENE: which of the scene's lights engines would drop (docs/check.md).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <memory>

#include "base/error.h"
#include "base/log.h"
#include "base/write_file.h"
#include "check/light_limits.h"
#include "check/limit_words.h"
#include "command_line/commands.h"
#include "command_line/findings.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "compare/contestants.h"
#include "measures/flip.h"
#include "measures/metrics.h"
#include "measures/results.h"
#include "plan/settings/model.h"
#include "report/limits_page.h"
#include "run/technique_run.h"
#include "scene/hidden.h"

namespace lightgrid::app {
using namespace lab;
namespace {

using nlohmann::ordered_json;

struct CheckOptions {
  std::string engine = "all", json, sarif, html;
  bool shorten = false;
  SceneChoice scene;
  DeviceOptions devices;
};

// A scene along its path.
struct CheckedScene {
  ChosenScene chosen;
  std::vector<View> path;  // one view or more
  SceneMotion advance;

  explicit CheckedScene(const SceneChoice& choice) : chosen(load_chosen_scene(choice)) {
    path = chosen_path(chosen.scene, chosen.view, choice);
    if (!path.empty() || choice.light_motion != "none") advance = chosen_motion(chosen.scene, choice);
    if (path.empty()) path = {chosen.view};
  }
  CheckedScene(const CheckedScene&) = delete;

  const View& move_to(size_t frame) {
    if (advance) advance(frame);
    return path[frame];
  }
};

// "4 of 13 engines keep all lights: bevy, filament, …".
std::string summary_of(const std::vector<LimitResult>& results, const std::string& engine) {
  std::map<std::string, bool> keeps;
  for (const LimitResult& result : results) {
    const auto [found, is_new] = keeps.emplace(result.limit->engine, true);
    found->second = found->second && result.holds();
  }
  for (const UnlimitedEngine& unlimited : unlimited_engines())
    if (engine == "all" || engine == unlimited.engine) keeps.emplace(unlimited.engine, true);
  std::vector<std::string> names;
  for (const auto& [name, all] : keeps)
    if (all) names.push_back(name);
  return fmt::format("{} of {} engine{} keep{} all lights{}{}", names.size(), keeps.size(),
                     keeps.size() == 1 ? "" : "s", keeps.size() == 1 ? "s" : "", names.empty() ? "" : ": ",
                     fmt::join(names, ", "));
}

void print_text(const std::vector<LimitResult>& results, const Scene& scene, const std::string& engine) {
  constexpr size_t max_lights = 3;
  for (const LimitResult& result : results) {
    const std::vector<std::string> lines = sentences_of(result, scene, max_lights);
    fmt::print("{} ({}): {}", id_of(*result.limit), result.limit->versions,
               result.holds() ? "holds: " + lines.front() + "\n" : "drops lights\n");
    if (result.holds()) continue;
    for (const std::string& line : lines) fmt::print("  {}\n", line);
    if (*result.limit->not_verified) fmt::print("  not verified: {}\n", result.limit->not_verified);
    fmt::print("  source: {}\n", result.limit->source);
  }
  for (const UnlimitedEngine& unlimited : unlimited_engines())
    if (engine == "all" || engine == unlimited.engine)
      fmt::print("{}: holds: {}\n", unlimited.engine, unlimited.why);
  fmt::print("{}\n", summary_of(results, engine));
}

// Along the path; shorten: with ranges of 90 % to 10 % too.
std::vector<LimitResult> counted(const std::vector<const EngineLimit*>& limits, const LightRanges& ranges,
                                 CheckedScene& checked, bool shorten) {
  std::vector<LightCheck> checks;
  for (int tenths = 10; tenths >= (shorten ? 1 : 10); --tenths)
    checks.emplace_back(limits, ranges, tenths / 10.0);
  const auto progress = progress_bar();
  for (size_t i = 0; i < checked.path.size(); ++i) {
    progress(double(i) / double(checked.path.size()), fmt::format("frame {}", i));
    const View& view = checked.move_to(i);
    for (LightCheck& check : checks) check.count(checked.chosen.scene, view);
  }
  progress(1, "");
  std::vector<LimitResult> results = checks.front().results();
  for (size_t c = checks.size(); c-- > 0;) {
    const std::vector<LimitResult> shorter = checks[c].results();
    for (size_t r = 0; r < results.size(); ++r)
      if (shorter[r].holds()) results[r].holds_at = double(10 - c) / 10;
  }
  return results;
}

ordered_json place_json(const LimitPlace& place, const Scene& scene) {
  ordered_json json = {{"frame", place.frame}, {"counted", place.counted}};
  if (*place.kind) json["kind"] = place.kind;
  if (place.instance >= 0) {
    json["mesh"] = place.instance;
    json["mesh_name"] = scene.instances[size_t(place.instance)].name;
  }
  if (place.cell.x >= 0) json["cell"] = {place.cell.x, place.cell.y, place.cell.z};
  return json;
}

ordered_json limit_json(const LimitResult& result, const Scene& scene) {
  const EngineLimit& limit = *result.limit;
  ordered_json json = {{"limit", id_of(limit)},
                       {"engine", limit.engine},
                       {"versions", limit.versions},
                       {"scope", name_of(limit.scope)},
                       {"most", limit.scope == LimitScope::distance ? size_t(limit.most) : result.most},
                       {"order", name_of(limit.order)},
                       {"source", limit.source},
                       {"not_verified", limit.not_verified},
                       {"change", limit.change},
                       {"holds", result.holds()},
                       {"holds_at_ranges", result.holds_at > 0 ? ordered_json(result.holds_at) : nullptr},
                       {"frames_over", result.frames_over},
                       {"places_over", result.places_over},
                       {"worst", place_json(result.worst, scene)},
                       {"over", ordered_json::array()},
                       {"dropped", ordered_json::array()}};
  for (const LimitPlace& place : result.over) json["over"].push_back(place_json(place, scene));
  for (const DroppedLight& dropped : result.dropped)
    json["dropped"].push_back({{"light", dropped.light},
                               {"name", scene.lights[size_t(dropped.light)].name},
                               {"places", dropped.places},
                               {"first", place_json(dropped.first, scene)}});
  std::string why;
  const auto picture = limit_picture(limit, scene, why);
  json["picture"] = picture ? ordered_json(picture->limited) : ordered_json();
  json["no_picture"] = why;
  return json;
}

ordered_json check_json(const std::vector<LimitResult>& results, const CheckedScene& checked,
                        const std::string& engine, const std::vector<Warning>& warnings) {
  const Scene& scene = checked.chosen.scene;
  const auto is_unlimited = [](const Light& light) {
    return !is_directional(light) && !std::isfinite(light.radius_m);
  };
  ordered_json json = {
      {"schema", 1},
      {"scene", scene.name},
      {"size", {checked.chosen.view.width, checked.chosen.view.height}},
      {"frames", checked.path.size()},
      {"lights", shown_counts(scene).lights},
      {"lights_without_range", std::ranges::count_if(scene.lights, is_unlimited)},
      {"holds", std::ranges::all_of(results, [](const LimitResult& r) { return r.holds(); })},
      {"warnings", warnings_json(warnings)},
      {"limits", ordered_json::array()},
      {"unlimited", ordered_json::array()}};
  for (const LimitResult& result : results) json["limits"].push_back(limit_json(result, scene));
  for (const UnlimitedEngine& unlimited : unlimited_engines())
    if (engine == "all" || engine == unlimited.engine)
      json["unlimited"].push_back(
          {{"engine", unlimited.engine}, {"source", unlimited.source}, {"why", unlimited.why}});
  return json;
}

ordered_json check_sarif(const std::vector<LimitResult>& results, const Scene& scene,
                         const std::string& file) {
  std::vector<FindingRule> rules;
  std::vector<Finding> findings;
  for (const LimitResult& result : results) {
    const EngineLimit& limit = *result.limit;
    rules.push_back({id_of(limit),
                     fmt::format("{}: lights past the limit of a {}", limit.engine, name_of(limit.scope)),
                     limit.source});
    for (const DroppedLight& dropped : result.dropped)
      findings.push_back(
          {id_of(limit),
           fmt::format("{} {}{}. {}", limit.engine, limit.scope == LimitScope::pool ? "may drop " : "drops ",
                       words_of(dropped, limit, scene), limit.change),
           file, name_of_light(dropped.light, scene)});
  }
  return sarif_log("lightgrid check", rules, findings);
}

// Draws limits for a page; a picture that several need once.
class LimitPictures {
 public:
  LimitPictures(const CheckOptions& o, CheckedScene& checked, LimitsPage& page)
      : o_(o), checked_(checked), page_(page) {}

  // Adds the pictures of the frame that exceeds the limit most.
  void add_to(LimitSection& section, const LimitResult& result) {
    std::string why;
    const auto picture = limit_picture(*result.limit, checked_.chosen.scene, why);
    if (!picture) {
      section.sentences.push_back("No picture: " + why + ".");
      return;
    }
    const size_t frame = result.worst.frame;
    const Drawn& every_light = drawn(picture->every_light, frame, {}, nullptr);
    const Drawn& limited = drawn(picture->limited, frame,
                                 picture->without_lost ? result.lost : std::vector<int>(), &every_light);
    const Difference& difference = difference_of(limited, every_light);
    section.pictures = {
        {fmt::format("Frame {}: every light ({})", frame, picture->every_light), every_light.number, {}},
        {fmt::format("Frame {}: {}. Rings: dropped lights", frame,
                     picture->without_lost ? "without the lights that are dropped"
                                           : "the limit (" + picture->limited + ")"),
         limited.number, places_of(result.dropped, frame)},
        {fmt::format("How visible the difference is (FLIP as displayed): black not at all, yellow most. It "
                     "shows in {:.1f} % of the pixels (above {})",
                     100 * difference.visible, visible_flip),
         difference.number,
         {}}};
    if (!picture->note.empty()) section.sentences.push_back(picture->note);
  }

 private:
  struct Drawn {
    Image image;
    Exposure exposure;
    size_t number = 0;  // in the page
  };

  struct Difference {
    double visible = 0;  // share of the pixels
    size_t number = 0;   // in the page
  };

  // The same for both: at most 960 pixels wide.
  size_t add_picture(const Image& image, const std::function<std::vector<uint8_t>(const Image&)>& bytes) {
    constexpr int max_width = 960;
    const Image shown = mean_of_blocks(image, (image.width + max_width - 1) / max_width);
    page_.pictures.push_back(encode_png(shown.width, shown.height, 3, bytes(shown)));
    return page_.pictures.size() - 1;
  }

  // Only of lights in front of the eye whose centre is in the picture.
  std::vector<glm::vec2> places_of(const std::vector<DroppedLight>& dropped, size_t frame) {
    const View& view = checked_.move_to(frame);
    std::vector<glm::vec2> places;
    for (const DroppedLight& each : dropped) {
      const Light& light = checked_.chosen.scene.lights[size_t(each.light)];
      if (is_directional(light)) continue;
      const glm::dvec4 clip = view.clip_from_view * view.view_from_world * glm::dvec4(light.position, 1);
      const glm::dvec2 place = glm::dvec2(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
      const bool inside = place.x >= 0 && place.x <= 1 && place.y >= 0 && place.y <= 1;
      if (clip.w > 0 && inside) places.emplace_back(place);
    }
    return places;
  }

  const Difference& difference_of(const Drawn& limited, const Drawn& every_light) {
    const auto [found, is_new] = differences_.try_emplace({limited.number, every_light.number});
    if (!is_new) return found->second;
    const std::vector<float> map = displayed_flip_map(limited.image, every_light.image, every_light.exposure);
    found->second.visible = displayed_flip_of(map).visible;
    found->second.number =
        add_picture(flip_picture(map, limited.image.width, limited.image.height), srgb_bytes_as_is);
    return found->second;
  }

  // like: with its exposure; null: one of its own.
  const Drawn& drawn(const std::string& technique, size_t frame, const std::vector<int>& without,
                     const Drawn* like) {
    Drawn& drawn = drawn_[{technique, frame, without}];
    if (!drawn.image.pixels.empty()) return drawn;
    std::string name = technique;
    SceneChoice choice = o_.scene;
    take_own_settings(name, choice.set);
    const Settings settings = chosen_settings(choice);
    const View& view = checked_.move_to(frame);
    Scene scene = checked_.chosen.scene;
    for (const int light : without) scene.lights[size_t(light)].intensity = 0;
    Renderer renderer = open_devices(o_.devices, name, settings);
    TechniqueRun run(renderer, scene, view, settings, find_technique(name));
    run.run_frame();
    drawn.image = run.take_image();
    drawn.exposure = like ? like->exposure : chosen_exposure(o_.scene, drawn.image);
    drawn.number =
        add_picture(drawn.image, [&](const Image& shown) { return srgb_bytes(shown, drawn.exposure); });
    return drawn;
  }

  const CheckOptions& o_;
  CheckedScene& checked_;
  LimitsPage& page_;
  std::map<std::tuple<std::string, size_t, std::vector<int>>, Drawn> drawn_;
  std::map<std::pair<size_t, size_t>, Difference> differences_;
};

std::string page_of(const CheckOptions& o, const std::vector<LimitResult>& results, CheckedScene& checked,
                    const std::vector<Warning>& warnings) {
  constexpr size_t max_lights = 8;
  const Scene& scene = checked.chosen.scene;
  LimitsPage page;
  page.scene = scene.name;
  const View& view = checked.chosen.view;
  const size_t frames = checked.path.size();
  page.view = fmt::format("{} x {} · {} frame{} · {} lights", view.width, view.height, frames,
                          frames == 1 ? "" : "s", shown_counts(scene).lights);
  page.aspect = double(view.width) / view.height;
  page.warnings = warnings;
  page.verdict = summary_of(results, o.engine) + ".";
  LimitPictures pictures(o, checked, page);
  for (const LimitResult& result : results) {
    LimitSection& section = page.sections.emplace_back();
    section.title = fmt::format("{} ({})", id_of(*result.limit), result.limit->versions);
    section.holds = result.holds();
    section.sentences = sentences_of(result, scene, max_lights);
    if (*result.limit->not_verified)
      section.sentences.push_back(std::string("Not verified: ") + result.limit->not_verified + ".");
    section.source = result.limit->source;
    if (!result.holds()) pictures.add_to(section, result);
  }
  return limits_page(page);
}

std::string text_of(const ordered_json& json) {
  return json.dump(1, ' ', false, ordered_json::error_handler_t::replace);
}

// Counting reads where lights end; pictures read what their techniques do.
void check_settings(const Settings& settings, bool pictures) {
  if (pictures) {
    std::vector<Contestant> all;
    for (const Technique* technique : techniques()) all.push_back({technique, settings});
    return check_given_settings(settings, all);
  }
  const std::array read = {"range", "cutoff", "window", "alpha", "light-seed"};
  for (const std::string& key : given_keys(settings))
    if (std::ranges::count(read, key) == 0)
      throw input_error(
          "set {}: check does not read it without --html, and it would change nothing; it reads {}", key,
          fmt::join(read, ", "))
          .about(key);
}

int check(CheckOptions o) {
  check_output_files({{"--json", o.json}, {"--sarif", o.sarif}, {"--html", o.html}});
  parse_gl_backend(o.devices.gl);
  const std::vector<const EngineLimit*> limits = limits_of(o.engine);
  const Settings settings = chosen_settings(o.scene);
  check_settings(settings, !o.html.empty());
  o.scene.device = o.devices.device;
  const WarningCollector warnings;
  CheckedScene checked(o.scene);
  const std::vector<LimitResult> results = counted(limits, ranges_of(settings), checked, o.shorten);
  const Scene& scene = checked.chosen.scene;
  if (!o.json.empty())
    write_json(o.json, text_of(check_json(results, checked, o.engine, warnings.warnings())));
  if (!o.sarif.empty()) write_json(o.sarif, text_of(check_sarif(results, scene, o.scene.scene)));
  if (o.json != "-" && o.sarif != "-") print_text(results, scene, o.engine);
  if (!o.html.empty()) write_file(o.html, page_of(o, results, checked, warnings.warnings()));
  return std::ranges::any_of(results, [](const LimitResult& r) { return !r.holds(); });
}

}  // namespace

void add_check(CommandLine& line) {
  auto o = std::make_shared<CheckOptions>();
  Subcommand command = line.add("check", "the lights that engines would drop, along a camera's path",
                                [o] { return check(*o); });
  add_scene_options(command, o->scene);
  add_path_option(command, o->scene);
  add_exposure_option(command, o->scene);
  add_device_options(command, o->devices);
  command.option("--engine", o->engine, "an engine by its name, or all (docs/check.md)");
  command.flag("--shorten", o->shorten, "finds how far all lights' ranges must shrink until limits hold");
  command.option("--json", o->json, "results as JSON into a file, - for stdout");
  command.option("--sarif", o->sarif, "dropped lights as SARIF 2.1.0 into a file, - for stdout");
  command.option("--html", o->html, "a page of the results, into a file");
}

}  // namespace lightgrid::app
