// lightgrid capture SCENE -o DIR: depth, lights, view and light grid as files.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "frames/capture.h"
#include "frames/frame_summary.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct CaptureOptions {
  SceneChoice scene;
  DeviceOptions devices;
  std::string technique, output = "out/capture", json;
};

// Writes one frame into `folder` and returns its summary as JSON.
std::string capture_into(const std::string& folder, Renderer& devices, const CapturedFrame& frame,
                         const Settings& settings, const Technique& technique, const CaptureOptions& o) {
  make_folder(folder);
  FrameCuller culler(*devices.cl, *devices.kernels, frame, settings, grid_needs(technique.name, settings));
  culler.run();
  const FrameGrid grid = culler.grid();
  write_frame(folder, frame);
  write_frame_grid(folder, grid);
  if (o.json != "-") fmt::print("{}: {}\n", folder, summary_line(frame, grid));
  return summary_json(frame, grid, devices.cl->info().name);
}

// A folder for each view of the camera path, numbered: frames for `bench --replay`.
std::string capture_path(const std::vector<View>& path, Renderer& devices, Scene& scene,
                         const Settings& settings, const Technique& technique, const CaptureOptions& o) {
  const SceneMotion advance = chosen_motion(scene, o.scene);
  SceneCapture capture(devices, scene, path.front(), settings, technique);
  std::string summaries;
  for (size_t i = 0; i < path.size(); ++i) {
    const SceneChanges changes = advance ? advance(i) : SceneChanges();
    const std::string folder = (std::filesystem::path(o.output) / fmt::format("{:04}", i)).string();
    summaries += (i ? ",\n" : "") +
                 capture_into(folder, devices, capture.frame(path[i], changes), settings, technique, o);
  }
  return "[" + summaries + "]";
}

int capture_all(const CaptureOptions& o, const Settings& settings, ChosenScene& chosen,
                const std::vector<View>& path) {
  Renderer devices = open_devices(o.devices, o.technique, settings);
  const Technique& technique = technique_or_default(o.technique, devices);
  check_given_settings(settings, {{&technique, settings}}, {.grid = true});
  const std::string summary =
      path.empty() ? capture_into(o.output, devices,
                                  capture_frame(devices, chosen.scene, chosen.view, settings, technique),
                                  settings, technique, o)
                   : capture_path(path, devices, chosen.scene, settings, technique, o);
  if (!o.json.empty()) write_json(o.json, summary);
  return 0;
}

int capture(CaptureOptions o) {
  take_own_settings(o.technique, o.scene.set);
  const Settings settings = chosen_settings(o.scene);
  if (!o.technique.empty())
    grid_needs(o.technique, settings);  // reports faults of the technique before the work
  parse_gl_backend(o.devices.gl);
  if (!o.json.empty()) check_output_file("--json", o.json);
  o.scene.device = o.devices.device;
  ChosenScene chosen = load_chosen_scene(o.scene);
  const std::vector<View> path = chosen_path(chosen.scene, chosen.view, o.scene);
  return with_output_folder(o.output, [&] { return capture_all(o, settings, chosen, path); });
}

}  // namespace

void add_capture(CommandLine& line) {
  auto o = std::make_shared<CaptureOptions>();
  Subcommand command =
      line.add("capture", "depth, lights, view and light grid as files", [o] { return capture(*o); });
  add_scene_options(command, o->scene);
  add_path_option(command, o->scene);
  add_device_options(command, o->devices);
  add_technique_option(command, o->technique, "whose light grid is written; clustered's has slices");
  command.option("-o,--output", o->output, "folder of the frame");
  command.option("--json", o->json, "summary as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
