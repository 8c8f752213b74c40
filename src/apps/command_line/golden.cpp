// lightgrid golden record|check DIR: pictures held by hash, not by threshold (docs/golden.md).
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "base/version.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/findings.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "golden/golden.h"
#include "golden/golden_pictures.h"
#include "measures/metrics.h"
#include "measures/results.h"

namespace lightgrid::app {
using namespace lab;
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

struct GoldenOptions {
  std::string action, folder, technique = "visibility", output, json, junit, sarif;
  std::vector<std::string> scenes;
  bool pictures = false;
  SceneChoice scene;
  DeviceOptions devices;
};

constexpr const char* golden_file = "golden.json";
constexpr int golden_format = 2;

// The name of a view's files.
std::string picture_name(size_t scene, size_t view) { return fmt::format("{:02}_{:04}", scene, view); }

std::string text_of(const ChoiceField& field, const SceneChoice& choice) {
  return std::visit([&](auto member) { return fmt::format("{}", choice.*member); }, field.value);
}

// The fields of a choice that are not the defaults.
ordered_json choice_json(const SceneChoice& choice) {
  ordered_json object = ordered_json::object();
  for (const ChoiceField& field : choice_fields()) {
    if (text_of(field, choice) != text_of(field, {})) object[field.name] = text_of(field, choice);
  }
  return object;
}

struct GoldenScene {
  std::string technique;
  SceneChoice choice;
};

// Draws each view of the choice, and hands it over.
void draw_views(const GoldenScene& golden, DeviceOptions devices,
                const std::function<void(size_t view, TechniqueRun& run)>& take) {
  SceneChoice choice = golden.choice;
  std::string name = golden.technique;
  take_own_settings(name, choice.set);
  const Settings settings = chosen_settings(choice);
  const Technique& technique = find_technique(name);
  check_given_settings(settings, {{&technique, settings}});
  choice.device = devices.device;
  ChosenScene chosen = load_chosen_scene(choice);
  std::vector<View> path = chosen_path(chosen.scene, chosen.view, choice);
  Renderer renderer = open_devices(devices, name, settings);
  const SceneMotion advance = chosen_motion(chosen.scene, choice);
  if (path.empty() && choice.light_motion != "none") advance(0);
  GpuScene gpu(renderer, chosen.scene);
  TechniqueRun run(renderer, gpu, chosen.view, settings, technique);
  for (size_t i = 0; i < std::max<size_t>(1, path.size()); ++i) {
    if (!path.empty()) {
      const SceneChanges changes = advance ? advance(i) : SceneChanges();
      gpu.update(changes);
      run.look(path[i], changes);
    }
    run.run_frame();
    if (renderer.counts().cl_programs == 0)
      throw machine_error("{}: no OpenCL kernel ran: a picture without one says nothing", choice.scene);
    take(i, run);
  }
}

int record(const GoldenOptions& o) {
  if (o.scenes.empty()) throw input_error("golden record: SCENE is missing: one or more");
  return with_output_folder(o.folder, [&] {
    ordered_json scenes;
    size_t count = 0;
    for (const std::string& scene : o.scenes) {
      const size_t number = scenes.size();
      GoldenScene golden{o.technique, o.scene};
      golden.choice.scene = scene;
      ordered_json views;
      draw_views(golden, o.devices, [&](size_t i, TechniqueRun& run) {
        if (views.empty() && !own_surfaces(run.technique(), run.view().plan.settings))
          log_warning("{}: {} draws with OpenGL: its bytes hold for this driver alone", scene, o.technique);
        const GoldenPixels pixels = golden_pixels(run);
        views.push_back(to_json(golden_view(pixels)));
        if (o.pictures)
          save_golden_pixels(std::filesystem::path(o.folder) / (picture_name(number, i) + ".exr"), pixels);
        ++count;
      });
      scenes.push_back({{"scene", scene},
                        {"technique", o.technique},
                        {"options", choice_json(o.scene)},
                        {"set", o.scene.set},
                        {"views", views}});
    }
    const ordered_json file = {{"lightgrid_golden", golden_format},
                               {"version", version_of_build()},
                               {"commit", commit_of_build()},
                               {"scenes", scenes}};
    const std::filesystem::path path = std::filesystem::path(o.folder) / golden_file;
    write_file(path, file.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
    fmt::print("{}: {} {}\n", path.string(), count, count == 1 ? "view" : "views");
    return 0;
  });
}

struct CheckedView {
  std::string name, stage, message;  // the latter two are empty where nothing differs
  std::optional<GoldenDifference> difference;
  std::optional<PicturePixel> pixel;  // where pixels are stored
  std::optional<DisplayedFlip> flip;
};

struct RecordedScene {
  GoldenScene golden;
  std::vector<GoldenView> views;
};

std::vector<RecordedScene> read_golden(const std::filesystem::path& path) {
  const std::string text = read_small_file(path, 64 << 20, "a golden file");
  try {
    const json parsed = parsed_json(text, 8);
    const JsonFields file(parsed);
    if (file.count("lightgrid_golden") != golden_format)
      throw input_error(
          "lightgrid_golden: {} is another format than {}, which this program reads: record again",
          file.count("lightgrid_golden"), golden_format);
    file.check_fields({"lightgrid_golden", "version", "commit", "scenes"});
    std::vector<RecordedScene> scenes;
    const json& list = file.at("scenes");
    if (!list.is_array() || list.empty()) throw input_error("scenes: is not a list of one or more");
    for (size_t i = 0; i < list.size(); ++i) {
      const JsonFields fields(list[i], fmt::format("scenes[{}].", i));
      fields.check_fields({"scene", "technique", "options", "set", "views"});
      RecordedScene& scene = scenes.emplace_back();
      scene.golden.choice.scene = fields.text("scene");
      scene.golden.technique = fields.text("technique");
      const JsonFields options = fields.object("options");
      for (const std::string& name : options.names())
        set_choice_field(scene.golden.choice, name + "=" + options.text(name));
      const json& set = fields.at("set");
      if (!set.is_array() || !std::ranges::all_of(set, [](const json& s) { return s.is_string(); }))
        throw input_error("scenes[{}].set: is not a list of texts", i);
      scene.golden.choice.set = set.get<std::vector<std::string>>();
      const json& views = fields.at("views");
      if (!views.is_array() || views.empty())
        throw input_error("scenes[{}].views: is not a list of one or more", i);
      for (size_t v = 0; v < views.size(); ++v)
        scene.views.push_back(golden_view(JsonFields(views[v], fmt::format("scenes[{}].views[{}].", i, v))));
    }
    return scenes;
  } catch (const Error& error) {
    throw Error(error.kind(), path.string() + ": " + error.what());
  }
}

// An error ends a check before its last view.
struct GoldenError {
  std::string scene, message;
};

std::string junit_text(const std::vector<CheckedView>& checked, const std::optional<GoldenError>& error) {
  const auto differ = std::ranges::count_if(checked, [](const CheckedView& c) { return !c.stage.empty(); });
  std::string text = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuite name=\"lightgrid golden\" tests=\"{}\" "
      "failures=\"{}\" errors=\"{}\">\n",
      checked.size() + error.has_value(), differ, int(error.has_value()));
  const auto add_case = [&](const std::string& name, const std::string& fault) {
    text += fmt::format("  <testcase classname=\"golden\" name=\"{}\"{}\n", xml_escaped(name),
                        fault.empty() ? "/>" : ">" + fault + "</testcase>");
  };
  for (const CheckedView& c : checked)
    add_case(c.name, c.stage.empty() ? ""
                                     : fmt::format("<failure type=\"{}\" message=\"{}\"/>", c.stage,
                                                   xml_escaped(c.message)));
  if (error) add_case(error->scene, fmt::format("<error message=\"{}\"/>", xml_escaped(error->message)));
  return text + "</testsuite>\n";
}

ordered_json sarif(const std::vector<CheckedView>& checked, const std::string& file) {
  std::vector<FindingRule> rules;
  std::vector<Finding> findings;
  for (const char* stage : golden_stages)
    rules.push_back({stage, fmt::format("{} is the first stage that differs", stage)});
  for (const CheckedView& c : checked)
    if (!c.stage.empty()) findings.push_back({c.stage, c.name + ": " + c.message, file});
  return sarif_log("lightgrid golden", rules, findings);
}

std::string in_words(const GoldenDifference& d, const GoldenView& view) {
  return fmt::format("differs first in {}: {} of {} tiles, the first at pixels {},{} to {},{}",
                     golden_stages[d.stage], d.tiles, view.stages[d.stage].size(), d.tile_x * view.tile,
                     std::max(0, view.height - (d.tile_y + 1) * view.tile),
                     std::min(view.width, (d.tile_x + 1) * view.tile) - 1,
                     flipped_row(d.tile_y * view.tile, view.height));
}

// Compares a view with the recorded one, and writes its pictures if it differs and a folder is given.
CheckedView checked_view(const GoldenOptions& o, const RecordedScene& scene, const std::string& picture,
                         size_t i, TechniqueRun& run) {
  CheckedView c{fmt::format("{} {} {}", scene.golden.choice.scene, scene.golden.technique, i)};
  const GoldenView& expected = scene.views[i];
  const GoldenPixels pixels = golden_pixels(run);
  const GoldenView drawn = golden_view(pixels);
  c.difference = first_difference(expected, drawn);
  if (!c.difference) return c;
  c.stage = golden_stages[c.difference->stage];
  c.message = in_words(*c.difference, drawn);
  const auto recorded = load_golden_pixels(std::filesystem::path(o.folder) / (picture + ".exr"), expected);
  const Exposure exposure = chosen_exposure(scene.golden.choice, recorded ? recorded->image : pixels.image);
  const GoldenPictures pictures{expected, drawn, *c.difference, pixels, recorded, exposure};
  if (recorded) {
    c.pixel = first_pixel(*recorded, pixels, drawn, *c.difference);
    c.flip = pictures.flip();
    c.message += fmt::format("; the first pixel {},{}; FLIP {:.4f}, visible at {:.2f} % of the pixels",
                             c.pixel->x, c.pixel->y, c.flip->mean, 100 * c.flip->visible);
  }
  if (!o.output.empty()) pictures.save(o.output, picture);
  return c;
}

ordered_json to_json(const CheckedView& c) {
  ordered_json view = {{"view", c.name}, {"same", !c.difference}, {"stage", c.stage}, {"message", c.message}};
  view["tile"] = c.difference ? json{c.difference->tile_x, c.difference->tile_y} : json();
  view["pixel_from_top"] = c.pixel ? json{c.pixel->x, c.pixel->y} : json();
  view["displayed_flip"] = c.flip ? json{{"mean", c.flip->mean}, {"visible_share", c.flip->visible}} : json();
  return view;
}

int check(const GoldenOptions& o) {
  check_output_files({{"--json", o.json}, {"--junit", o.junit}, {"--sarif", o.sarif}});
  const std::string path = (std::filesystem::path(o.folder) / golden_file).string();
  const std::vector<RecordedScene> scenes = read_golden(path);
  if (!o.output.empty()) make_folder(o.output);
  const bool lines_on_stdout = o.json != "-" && o.junit != "-" && o.sarif != "-";
  std::vector<CheckedView> checked;
  for (size_t s = 0; s < scenes.size(); ++s) {
    const RecordedScene& scene = scenes[s];
    size_t drawn = 0;
    try {
      draw_views(scene.golden, o.devices, [&](size_t i, TechniqueRun& run) {
        ++drawn;
        if (i >= scene.views.size()) return;
        const CheckedView& c = checked.emplace_back(checked_view(o, scene, picture_name(s, i), i, run));
        if (lines_on_stdout) fmt::print("{}: {}\n", c.name, c.difference ? c.message : "same");
      });
      if (drawn != scene.views.size())
        throw input_error("{}: scenes[{}].views: {} are recorded, and {} were drawn", path, s,
                          scene.views.size(), drawn);
    } catch (const Error& error) {
      // A report of an earlier run must not stand for this one.
      if (!o.junit.empty())
        write_json(o.junit, junit_text(checked, GoldenError{scene.golden.choice.scene, error.what()}));
      throw;
    }
  }
  if (!o.junit.empty()) write_json(o.junit, junit_text(checked, {}));
  if (!o.sarif.empty()) write_json(o.sarif, sarif(checked, path).dump(1));
  if (!o.json.empty()) {
    ordered_json views;
    for (const CheckedView& c : checked) views.push_back(to_json(c));
    write_json(o.json, ordered_json{{"views", views}}.dump(1));
  }
  return std::ranges::any_of(checked, [](const CheckedView& c) { return c.difference.has_value(); });
}

// An option of the other action would change nothing, and a script would take its result for another's.
void refuse_options_of_record(const GoldenOptions& o) {
  if (o.pictures) throw input_error("golden check: --pictures: is an option of record; see -o");
  std::string given;
  const ordered_json choice = choice_json(o.scene);
  if (!choice.empty()) given = "--" + choice.begin().key();
  if (!o.scene.set.empty()) given = "--set";
  if (o.technique != GoldenOptions().technique) given = "--technique";
  if (!given.empty())
    throw input_error("golden check: {}: is an option of record; views are drawn as {} says", given,
                      golden_file);
}

void refuse_options_of_check(const GoldenOptions& o) {
  for (const auto& [option, value] :
       {std::pair{"--output", o.output}, {"--json", o.json}, {"--junit", o.junit}, {"--sarif", o.sarif}})
    if (!value.empty()) throw input_error("golden record: {}: is an option of check", option);
}

int golden(const GoldenOptions& o) {
  if (o.folder.empty()) throw input_error("golden: DIR is missing: the folder of {}", golden_file);
  if (std::filesystem::is_regular_file(o.folder))
    throw input_error("golden {}: is a file; DIR is the folder of {}", o.folder, golden_file);
  parse_gl_backend(o.devices.gl);
  if (o.action == "record") {
    refuse_options_of_check(o);
    return record(o);
  }
  if (o.action != "check") throw input_error("golden {}: is neither record nor check", o.action);
  refuse_options_of_record(o);
  if (!o.scenes.empty()) throw input_error("golden check: {}: takes no scene but DIR's", o.scenes.front());
  return check(o);
}

}  // namespace

void add_golden(CommandLine& line) {
  auto o = std::make_shared<GoldenOptions>();
  Subcommand command =
      line.add("golden", "pictures held by hash: record them, or check that they are drawn again",
               [o] { return golden(*o); });
  command.option("action", o->action, "record or check");
  command.option("folder", o->folder, "folder of golden.json");
  command.list("scene", o->scenes, "of record, one or more: .gltf or .glb files, or built-in scenes");
  command.option("--size", o->scene.size, "image size, WxH");
  command.option("--lights", o->scene.lights, "scatter N lights; with --lights-file, its first N", 0,
                 max_lights);
  add_view_options(command, o->scene);
  add_path_option(command, o->scene);
  add_device_options(command, o->devices);
  add_technique_option(command, o->technique, technique_names());
  command.flag("--pictures", o->pictures, "of record: stores each view's pixels too, as DIR/SCENE_VIEW.exr");
  command.option("-o,--output", o->output, "of check: folder for the pictures of views that differ");
  command.option("--json", o->json, "of check: results as JSON into a file, - for stdout");
  command.option("--junit", o->junit, "results as JUnit XML into a file, - for stdout");
  command.option("--sarif", o->sarif, "of check: differences as SARIF 2.1.0 into a file, - for stdout");
}

}  // namespace lightgrid::app
