// lightgrid verify: the hard cases of culling on this machine's OpenCL devices.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/log.h"
#include "command_line/commands.h"
#include "command_line/options.h"
#include "command_line/progress.h"
#include "command_line/verify_hunt.h"
#include "measures/results.h"
#include "verify/run.h"

namespace lightgrid::app {
using namespace lab;
namespace {

struct VerifyCommand {
  std::string device, filter, json, replay;
  std::vector<std::string> set;
  bool nightly = false, list = false;
  HuntCommand hunt;
};

std::vector<std::unique_ptr<verify::CullEngine>> engines_of(const std::string& device) {
  const std::vector<ClDeviceInfo> present = list_cl_devices();
  std::vector<std::unique_ptr<verify::CullEngine>> engines;
  const auto add = [&](size_t i) {  // by number: several GPUs may have the same name
    const std::string why = why_not_the_same_bytes(present[i]);
    if (!why.empty()) {
      std::fprintf(stderr, "lightgrid: %s: other devices' bytes may differ, since %s\n",
                   present[i].name.c_str(), why.c_str());
    }
    engines.push_back(verify::device_engine("#" + std::to_string(i)));
  };
  if (!device.empty() || present.empty())
    add(choose_cl_device(present, device));  // reports faults
  else
    for (size_t i = 0; i < present.size(); ++i) add(i);
  return engines;
}

// Prints each case when it ends, below the name of its device.
class CaseLines {
 public:
  void print(const verify::CaseResult& result) {
    if (result.device != device_) fmt::print("{}\n", device_ = result.device);
    const verify::Outcome& o = result.outcome;
    const char* verdicts[] = {"pass", "FAIL", "skip"};
    fmt::print("  {} {:<42} {:>9} contacts  {:>9} trials  {:>6} lost  {:>7}{}{}\n", verdicts[int(o.verdict)],
               fmt::format("{}/{}", result.hard_case->group, result.hard_case->name), o.contacts, o.trials,
               o.lost, o.excess_ratio ? fmt::format("× {:.2f}", *o.excess_ratio) : "",
               o.why.empty() ? "" : "  ", o.why);
    std::fflush(stdout);
  }

 private:
  std::string device_;
};

void print_summary(const verify::VerifyReport& report) {
  fmt::print("{} of {} failed\n", report.failed, report.cases.size());
  if (report.unbuilt) fmt::print("{} not run: the driver cannot build their kernels\n", report.unbuilt);
}

void tell_duration(size_t cases) {
  constexpr double case_s = 4.3;  // 28 cases of depth/ on two busy cores
  const double seconds = double(cases) * case_s;
  log_info("{} cases: up to {} on two cores (--filter GROUP/ runs fewer)", cases,
           seconds < 90 ? fmt::format("{:.0f} s", std::ceil(seconds))
                        : fmt::format("{:.0f} min", std::ceil(seconds / 60)));
}

int hunt(const VerifyCommand& o) {
  if (!o.replay.empty() || o.nightly || o.list)
    throw input_error("verify: --hunt {} cannot be combined with --nightly, --list or --replay",
                      o.hunt.minutes);
  if (!o.json.empty()) check_output_file("--json", o.json);
  return run_hunt(o.hunt, *verify::device_engine(o.device), o.filter, o.json);
}

verify::VerifyReport replay(const VerifyCommand& o,
                            const std::vector<std::unique_ptr<verify::CullEngine>>& engines,
                            const CapturedFrame& frame, const verify::CaseFunction& found) {
  std::optional<FrameGrid> own = read_frame_grid(o.replay, frame);
  if (own && !own->cell_of_pixel.empty()) own.reset();  // not made of tiles: `cull --judge` compares it
  return verify::replay_frame(
      engines, frame, {verify::replayed_views(frame, own, o.set), own, o.nightly, found, progress_bar()});
}

int run(const VerifyCommand& o) {
  if (o.hunt.asked()) return hunt(o);
  const auto chosen = verify::chosen_cases(o.filter);
  if (!o.replay.empty() && (o.list || !o.filter.empty()))
    throw input_error("verify: --replay {} cannot be combined with --filter or --list", o.replay);
  if (o.replay.empty() && !o.set.empty()) throw input_error("verify: --set {} requires --replay", o.set[0]);
  if (o.list) {
    for (const std::string& row : verify::catalogue_rows(chosen)) fmt::print("{}\n", row);
    return 0;
  }
  if (!o.json.empty()) check_output_file("--json", o.json);
  CaseLines lines;
  verify::CaseFunction found;
  if (o.json != "-") found = [&](const verify::CaseResult& result) { lines.print(result); };
  verify::VerifyOptions options{.filter = o.filter, .found = found, .progress = progress_bar()};
  if (o.nightly) options.adversarial_lights = 10'000'000;
  const CapturedFrame frame = o.replay.empty() ? CapturedFrame() : read_frame(o.replay);
  const auto engines = engines_of(o.device);
  if (o.replay.empty()) tell_duration(chosen.size() * engines.size());
  const verify::VerifyReport report =
      o.replay.empty() ? verify::run_cases(engines, options) : replay(o, engines, frame, found);
  if (!o.json.empty()) write_json(o.json, verify::to_json(report).dump(1) + "\n");
  if (o.json != "-") print_summary(report);
  return report.failed ? 1 : report.unbuilt ? int(ErrorKind::machine) : 0;
}

}  // namespace

void add_verify(CommandLine& line) {
  auto o = std::make_shared<VerifyCommand>();
  Subcommand command =
      line.add("verify", "the hard cases of culling on this machine's devices", [o] { return run(*o); });
  command.option("--filter", o->filter, "only cases whose GROUP/NAME matches this regular expression");
  command.option("--device", o->device,
                 "only the OpenCL device whose platform and name contain this text; else all");
  command.option(
      "--replay", o->replay,
      "a captured frame's folder instead: compares its own lists, if it has any, and those made of it "
      "with the oracle, the latter also bit for bit with the float twin");
  command.list(
      "--set", o->set,
      "with --replay: slices=N, z-bins=N, slice-spacing=… to replay beside the frame's own; may be repeated");
  command.flag("--nightly", o->nightly,
               "ten million adversarial lights instead of a hundred thousand; with --replay every "
               "combination of cull test and depth bounds");
  command.flag("--list", o->list, "prints the catalogue as a table and runs nothing");
  add_hunt_options(command, o->hunt);
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid::app
