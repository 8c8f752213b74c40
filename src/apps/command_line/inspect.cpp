// lightgrid inspect SCENE --pixel X,Y: each light there, and which test kept or dropped it. -o DIR: the same
// for every pixel, as pictures. --compare KEY=A,B: the accuracy of the lists of several settings.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include "accuracy/frame_shadows.h"
#include "accuracy/shadow_truth.h"
#include "base/error.h"
#include "base/text.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "frames/capture.h"
#include "frames/frame_lists.h"
#include "frames/list_accuracy.h"
#include "inspect/inspect.h"
#include "measures/picture_pixel.h"
#include "plan/settings/grid.h"
#include "plan/settings/samples.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct InspectOptions {
  SceneChoice scene;
  DeviceOptions devices;
  std::string pixel, technique, output, json;
  std::vector<std::string> compare;
  int dropped = 10;
  bool all = false;
};

constexpr size_t max_compared = 1000;

std::optional<PicturePixel> parse_place(const std::string& text) {
  if (text.empty()) return {};
  const auto place = parse_pair<int>(text, ',');
  if (!place) throw input_error("--pixel {}: not X,Y", text);
  return PicturePixel{place->first, place->second};
}

void check_place(const PicturePixel& place, const View& view) {
  if (place.x >= 0 && place.y >= 0 && place.x < view.width && place.y < view.height) return;
  throw input_error("--pixel {},{}: the image has pixels 0,0 to {},{}", place.x, place.y, view.width - 1,
                    view.height - 1);
}

// The technique's frame, and the oracle of its shadows. Of many pairs, those at a sample of the pixels are
// decided.
struct FrameAndTruth {
  FrameAndTruth(Renderer& renderer, const ChosenScene& chosen, const Settings& settings,
                const Technique& technique)
      : run(renderer, chosen.scene, chosen.view, settings, technique), truth(chosen.scene, max_pairs) {
    run.draw_frame();
    frame = read_frame_shadows(run);
  }
  PairShadows pairs() {
    const ViewState& v = run.view();
    return {*truth.pairs(v, frame.depth, frame.shown), frame.shaded ? &*frame.shaded : nullptr,
            uint32_t(v.plan.lights.directional.size())};
  }

  static constexpr uint64_t max_pairs = 10'000'000;
  TechniqueRun run;
  ShadowTruth truth;
  FrameShadows frame;
};

// The input: a folder is a captured frame, which needs no OpenGL; anything else is a scene, to be captured
// first.
struct Subject {
  std::optional<ChosenScene> scene;
  CapturedFrame frame;
  Settings settings;
  std::string technique;  // the chosen one
  TechniqueNeeds needs{};
  std::unique_ptr<Renderer> renderer{};      // for `shadows`
  std::unique_ptr<FrameAndTruth> shadows{};  // where lights of the scene cast
  const View& view() const { return scene ? scene->view : frame.view; }
};

Subject load_frame(const SceneChoice& o) {
  const SceneChoice plain;
  const std::pair<const char*, bool> given[] = {{"--size", o.size != plain.size},
                                                {"--camera", !o.camera.empty()},
                                                {"--lights", o.lights >= 0},
                                                {"--lights-file", !o.lights_file.empty()},
                                                {"--light-radius", !o.light_radius.empty()},
                                                {"--virtual-lights", o.virtual_lights > 0},
                                                {"--ambient", !o.ambient.empty()},
                                                {"--environment", !o.environment.empty()},
                                                {"--shadows", !o.shadows.empty()}};
  for (const auto& [option, is_given] : given) {
    if (is_given) throw input_error("{}: {} is a captured frame, which has its own", option, o.scene);
  }
  Subject subject;
  subject.frame = read_frame(o.scene);
  subject.settings = frame_settings(subject.frame, o.set);
  return subject;
}

Subject load_subject(const SceneChoice& o) {
  std::error_code unreadable;
  if (std::filesystem::is_directory(o.scene, unreadable)) return load_frame(o);
  return {load_chosen_scene(o), {}, with_samples(chosen_settings(o), 1)};
}

struct OpenCl {
  std::unique_ptr<ClDevice> cl;
  std::unique_ptr<ProgramCache> kernels;
};

// Scenes are captured first, on the devices that the technique needs. Sets subject.technique.
OpenCl open_devices_for(Subject& subject, const InspectOptions& o) {
  subject.technique = o.technique.empty() ? "forward_plus" : o.technique;
  if (subject.scene) {
    auto renderer = std::make_unique<Renderer>(open_devices(o.devices, o.technique, subject.settings));
    const Technique& chosen = technique_or_default(o.technique, *renderer);
    subject.frame =
        capture_frame(*renderer, subject.scene->scene, subject.scene->view, subject.settings, chosen);
    subject.technique = chosen.name;
    if (ShadowTruth(subject.scene->scene, 0).casts()) {
      subject.shadows = std::make_unique<FrameAndTruth>(*renderer, *subject.scene, subject.settings, chosen);
      subject.renderer = std::move(renderer);
    }
  }
  OpenCl devices{std::make_unique<ClDevice>(o.devices.device), nullptr};
  devices.kernels = std::make_unique<ProgramCache>(*devices.cl);
  return devices;
}

bool says_exact(const Subject& subject) {
  return !is_approximate(find_technique(subject.technique), subject.settings);
}

// Returns 1 if a light was lost, or its shadow is wrong.
int inspect_place(const InspectOptions& o, const Subject& subject, FrameCuller& culler, const FrameGrid& grid,
                  const PicturePixel& place) {
  PixelInspection pixel = inspect_pixel(subject.frame, grid, culler.intervals(), subject.settings, place);
  bool wrong = false;
  if (subject.shadows) {
    const Scene& scene = subject.scene->scene;
    const PixelShadows here = subject.shadows->frame.at(pixel.x, pixel.y, subject.shadows->truth.occlusion());
    wrong = add_shadows(pixel, scene, here) && says_exact(subject);
  }
  const int most = o.all ? std::numeric_limits<int>::max() : o.dropped;
  if (!o.json.empty()) write_json(o.json, inspection_json(subject.frame, pixel, grid, most));
  if (o.json != "-") std::fputs(inspection_table(subject.frame, pixel, most).c_str(), stdout);
  return pixel.lost() || wrong ? 1 : 0;
}

int inspect_image(const InspectOptions& o, const Subject& subject, const FrameGrid& grid) {
  std::optional<PairShadows> shadows;
  if (subject.shadows) shadows.emplace(subject.shadows->pairs());
  InspectionMaps maps = inspection_maps(subject.frame, grid, shadows ? &*shadows : nullptr);
  if (maps.pairs.shadows) maps.pairs.shadows->says_exact = says_exact(subject);
  write_inspection_maps(o.output, subject.frame, maps);
  const PairCounts& pairs = maps.pairs;
  const auto a_pixel = [&](uint64_t count) {
    return maps.covered ? double(count) / double(maps.covered) : 0;
  };
  if (o.json != "-") {
    fmt::print("{}: listed.png, false_positives.png, lost.png; black is 0, yellow {} lights and more\n",
               o.output, maps.top);
    fmt::print(
        "  a pixel: {:.2f} listed, {:.2f} lit, {:.2f} listed but unlit; {} (pixel, light) pairs lost, {} "
        "wrong\n",
        a_pixel(pairs.listed), a_pixel(pairs.lit), a_pixel(pairs.listed - (pairs.lit - pairs.lost)),
        pairs.lost, pairs.wrong);
    if (pairs.shadows)
      fmt::print("  leaked.png, acned.png: {} pairs leaked, {} acned, {} undecided, at {} pixels\n",
                 pairs.shadows->leaked, pairs.shadows->acned, pairs.shadows->either, pairs.shadows->pixels);
  }
  if (!o.json.empty() && o.pixel.empty()) write_json(o.json, inspection_json(subject.frame, maps, grid));
  return pairs.lost || pairs.wrong || (pairs.shadows && pairs.shadows->faults()) ? 1 : 0;
}

// Compares each combination's lists with one result of the oracle.
int compare_settings(const InspectOptions& o, const Subject& subject, OpenCl& devices) {
  const LitBlocks truth = find_lit_blocks(subject.frame);
  std::vector<AccuracyRow> rows;
  uint64_t lost = 0;
  for (const BenchContestant& c : culling_contestants(subject.settings, o.compare, max_compared)) {
    FrameCuller culler(*devices.cl, *devices.kernels, subject.frame, c.settings,
                       grid_needs(subject.technique, c.settings));
    culler.run();
    const FrameGrid grid = culler.grid();
    if (grid.lists.slices != 1 || !grid.z_bin_edges.empty()) {
      throw input_error("inspect: --compare supports grids of one slice and no z-bins, not {} slices",
                        grid.lists.slices);
    }
    rows.push_back({c.compared, measure_lists(truth, c.settings[setting::tile], lists_of_cells(grid.lists))});
    lost += rows.back().accuracy.lost;
    if (o.json != "-") std::fputs(accuracy_line(rows.back()).c_str(), stdout);
  }
  if (!o.json.empty()) write_json(o.json, accuracy_json(subject.frame, subject.settings, rows));
  return lost ? 1 : 0;
}

int inspect(InspectOptions o) {
  take_own_settings(o.technique, o.scene.set);
  const std::optional<PicturePixel> place = parse_place(o.pixel);
  const bool one_grid = place || !o.output.empty();
  if (!one_grid && o.compare.empty()) {
    throw input_error("inspect: --pixel X,Y, -o DIR or --compare KEY=A,B is required");
  }
  if (one_grid && !o.compare.empty())
    throw input_error("inspect: --compare goes with neither --pixel nor -o");
  const Settings given = chosen_settings(o.scene);  // reports a wrong setting before the scene is loaded
  if (!o.technique.empty()) grid_needs(o.technique, given);
  check_given_settings(given, {{&find_technique(o.technique.empty() ? "forward_plus" : o.technique), given}},
                       {.grid = true});
  culling_contestants(given, o.compare, max_compared);
  parse_gl_backend(o.devices.gl);
  if (!o.json.empty()) check_output_file("--json", o.json);
  o.scene.device = o.devices.device;
  Subject subject = load_subject(o.scene);
  if (place) check_place(*place, subject.view());
  if (!o.output.empty()) make_folder(o.output);
  OpenCl devices = open_devices_for(subject, o);
  subject.needs = grid_needs(subject.technique, given);
  if (!one_grid) return compare_settings(o, subject, devices);
  FrameCuller culler(*devices.cl, *devices.kernels, subject.frame, subject.settings, subject.needs);
  culler.run();
  const FrameGrid grid = culler.grid();
  int status = 0;
  if (place) status = std::max(status, inspect_place(o, subject, culler, grid, *place));
  if (!o.output.empty()) status = std::max(status, inspect_image(o, subject, grid));
  return status;
}

}  // namespace

void add_inspect(CommandLine& line) {
  auto o = std::make_shared<InspectOptions>();
  Subcommand command = line.add("inspect", "each light at a pixel: which test kept or dropped it",
                                [o] { return inspect(*o); });
  add_scene_options(command, o->scene);
  add_device_options(command, o->devices);
  add_technique_option(command, o->technique, "whose light grid is inspected; clustered's has slices");
  command.option("--pixel", o->pixel, "X,Y from the upper left");
  command.option("--dropped", o->dropped, "how many dropped lights to show, the nearest first", 0,
                 100'000'000);
  command.flag("--all", o->all, "show every dropped light");
  command.option("-o,--output", o->output,
                 "folder of pictures: listed, listed but unlit, and lost lights of each pixel");
  command.list("--compare", o->compare,
               "KEY=VALUE,VALUE,…: accuracy of the lists of each; if repeated, every combination");
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
