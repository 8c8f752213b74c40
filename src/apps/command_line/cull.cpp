// lightgrid cull FRAME -o DIR: the light grid of a captured frame. Opens OpenCL only.
#include <fmt/format.h>

#include <memory>

#include "base/error.h"
#include "base/timer.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "frames/frame_summary.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct CullOptions {
  std::string frame, device, technique = "forward_plus", output = "out/cull", json;
  std::vector<std::string> set;
  TimingOptions timing;
};

int cull_into_folder(const CullOptions& o, const CapturedFrame& frame, const Settings& settings,
                     const TechniqueNeeds& needs) {
  ClDevice device(o.device);
  ProgramCache programs(device);
  FrameCuller culler(device, programs, frame, settings, needs);
  for (int i = 0; i < o.timing.warmup; ++i) culler.run();
  std::vector<double> ms;
  for (int i = 0; i < o.timing.frames; ++i) {
    const Timer timer;
    culler.run();
    ms.push_back(timer.elapsed_ms());
  }
  const FrameGrid grid = culler.grid();
  write_frame_grid(o.output, grid);
  const Spread time = spread_of(ms);
  if (!o.json.empty()) write_json(o.json, summary_json(frame, grid, device.info().name, time));
  if (o.json != "-") fmt::print("{}: {}, {:.3f} ms\n", o.output, summary_line(frame, grid), time.median);
  return 0;
}

int cull(CullOptions o) {
  take_own_settings(o.technique, o.set);
  if (o.frame.empty())
    throw input_error(
        "cull: FRAME is missing; it is a folder that `lightgrid capture` or another engine wrote");
  const TechniqueNeeds needs =
      grid_needs(o.technique, frame_settings({}, o.set));  // reports faults in these first
  if (!o.json.empty()) check_output_file("--json", o.json);
  const CapturedFrame frame = read_frame(o.frame);
  const Settings settings = frame_settings(frame, o.set);
  check_given_settings(settings, {{&find_technique(o.technique), settings}}, {.grid = true});
  return with_output_folder(o.output, [&] { return cull_into_folder(o, frame, settings, needs); });
}

}  // namespace

void add_cull(CommandLine& line) {
  auto o = std::make_shared<CullOptions>();
  Subcommand command =
      line.add("cull", "light grid of a captured frame, with OpenCL alone", [o] { return cull(*o); });
  command.option("frame", o->frame, "folder with view.json, lights.json and depth.f32");
  add_technique_option(command, o->technique, "whose light grid is made (clustered's has slices)");
  command.option("-o,--output", o->output, "folder of the grid");
  command.list("--set", o->set, "a setting, KEY=VALUE; may be repeated");
  command.option("--device", o->device, "OpenCL device, by a part of its name");
  add_timing_options(command, o->timing);
  command.option("--json", o->json, "summary as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
