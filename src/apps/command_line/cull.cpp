// lightgrid cull FRAME -o DIR: the light grid of a captured frame. Opens OpenCL only. --judge: the lights that
// the lists of the frame lack.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "base/error.h"
#include "base/timer.h"
#include "base/write_file.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "compare/contestants.h"
#include "frames/frame_summary.h"
#include "inspect/judge.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct CullOptions {
  std::string frame, device, technique = "forward_plus", output = "out/cull", json, junit;
  std::vector<std::string> set;
  TimingOptions timing;
  bool judge = false;
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

// Returns 1 if a light is lost, or an entry of a list is wrong.
int judge_lists(const CullOptions& o) {
  check_output_files({{"--json", o.json}, {"--junit", o.junit}});
  const CapturedFrame frame = read_frame(o.frame);
  const std::optional<FrameGrid> grid = read_frame_grid(o.frame, frame);
  if (!grid) throw input_error("{}/grid.json: there is none; --judge reads the lists of the frame", o.frame);
  const Judgement result = judge(frame, *grid);
  write_inspection_maps(o.output, frame, result.maps);
  if (o.json != "-" && o.junit != "-") {
    std::fputs(judgement_text(frame, result).c_str(), stdout);
    fmt::print("{}: listed.png, false_positives.png, lost.png\n", o.output);
  }
  if (!o.json.empty()) write_json(o.json, judgement_json(frame, *grid, result));
  if (!o.junit.empty()) write_json(o.junit, judgement_junit(frame, result));
  return result.maps.pairs.lost || result.maps.pairs.wrong ? 1 : 0;
}

int cull(CullOptions o) {
  take_own_settings(o.technique, o.set);
  if (o.frame.empty())
    throw input_error(
        "cull: FRAME is missing; it is a folder that `lightgrid capture` or another engine wrote");
  if (o.judge && !(o.set.empty() && o.device.empty()))
    throw input_error("cull: --judge goes with neither --set nor --device: it makes no lists");
  if (o.judge) return with_output_folder(o.output, [&] { return judge_lists(o); });
  if (!o.junit.empty()) throw input_error("cull: --junit goes with --judge");
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
  command.flag("--judge", o->judge, "makes no lists: compares those of the frame with the oracle");
  command.option("--junit", o->junit, "results as JUnit XML into a file, - for stdout");
}

}  // namespace lightgrid::app
