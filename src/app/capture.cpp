// lightgrid capture SCENE -o DIR: depth, lights, view and light grid as files.
#include <fmt/format.h>

#include <memory>

#include "app/commands.h"
#include "app/options.h"
#include "base/error.h"
#include "base/write_file.h"
#include "capture/capture.h"
#include "capture/frame_summary.h"

namespace lightgrid {
namespace {

struct CaptureOptions {
  SceneChoice scene;
  DeviceOptions devices;
  std::string technique = "forward_plus", output = "out/capture", json;
};

int capture(const CaptureOptions& o) {
  const Settings settings = chosen_settings(o.scene);
  const TechniqueNeeds needs = grid_needs(o.technique, settings);
  const GlBackend backend = parse_gl_backend(o.devices.gl);
  if (!o.json.empty()) check_output_file("--json", o.json);
  const ChosenScene chosen = load_chosen_scene(o.scene);
  make_folder(o.output);
  Renderer devices(o.devices.device, backend);
  const CapturedFrame frame = capture_frame(devices, chosen.scene, chosen.view, settings);
  FrameCuller culler(*devices.cl, *devices.kernels, frame, settings, needs);
  culler.run();
  const FrameGrid grid = culler.grid();
  write_frame(o.output, frame);
  write_frame_grid(o.output, grid);
  if (!o.json.empty()) write_json(o.json, summary_json(frame, grid, devices.cl->info().name));
  if (o.json != "-") fmt::print("{}: {}\n", o.output, summary_line(frame, grid));
  return 0;
}

}  // namespace

void add_capture(CommandLine& line) {
  auto o = std::make_shared<CaptureOptions>();
  Subcommand command =
      line.add("capture", "depth, lights, view and light grid as files", [o] { return capture(*o); });
  add_scene_options(command, o->scene);
  add_device_options(command, o->devices);
  command.option("-t,--technique", o->technique, "whose light grid is written (clustered's has slices)");
  command.option("-o,--output", o->output, "folder of the frame");
  command.option("--json", o->json, "summary as JSON into a file, - for stdout");
}

}  // namespace lightgrid
