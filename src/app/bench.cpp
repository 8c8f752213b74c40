// lightgrid bench: the culling pipeline's kernels against the machine's limits.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/commands.h"
#include "session/contestants.h"
#include "app/options.h"
#include "app/progress.h"
#include "base/error.h"
#include "bench/bench.h"
#include "bench/row_filter.h"
#include "bench/tune.h"

namespace lightgrid {
namespace {

struct BenchCommand {
  std::string device, filter, json, write_frames;
  std::vector<std::string> replay, set, compare;
  TimingOptions timing{30, 3};
  bool tune = false;
};

std::vector<BenchContestant> contestants_of(const BenchCommand& o) {
  Settings base;
  for (const std::string& assignment : o.set) apply_setting(base, assignment);
  return culling_contestants(base, o.compare, 64);
}

void check_frame_folder(const std::string& folder) {
  std::error_code unreadable;
  for (const char* file : {"view.json", "lights.json", "depth.f32"}) {
    if (!std::filesystem::is_regular_file(std::filesystem::path(folder) / file, unreadable)) {
      throw input_error("--replay {}: has no {}", folder, file);
    }
  }
}

std::vector<BenchCase> cases_of(const BenchCommand& o) {
  if (o.replay.empty()) return standard_cases();
  std::vector<BenchCase> cases;
  for (const std::string& folder : o.replay) {
    check_frame_folder(folder);
    const std::filesystem::path path = std::filesystem::path(folder).lexically_normal();
    cases.push_back({(path.has_filename() ? path : path.parent_path()).filename().string(), {}, folder});
  }
  return cases;
}

bool gives_tile(const std::vector<std::string>& assignments) {
  return std::any_of(assignments.begin(), assignments.end(), [](const std::string& a) { return a.starts_with("tile="); });
}

int tune(const BenchCommand& o) {
  if (tuned_sizes_file().empty()) throw input_error("--tune: LIGHTGRID_TUNED=off leaves no file to write");
  ClDevice device(o.device);
  TuneOptions options{o.timing.frames, o.timing.warmup, {}};
  options.step = progress_bar();
  const TuneResult result = tune_kernels(device, options);
  write_tuned_sizes(device.info(), result.best);
  nlohmann::ordered_json json = {{"device", device.info().name}, {"best", result.best}, {"file", tuned_sizes_file().string()},
                                 {"trials", nlohmann::ordered_json::array()}};
  for (const TuneTrial& t : result.trials) {
    json["trials"].push_back({{"setting", t.assignment}, {"ratio", t.ratio}, {"failure", t.failure}});
    if (o.json != "-") fmt::print("{:<28}{}\n", t.assignment, t.failure.empty() ? fmt::format("x {:.2f}", t.ratio) : t.failure);
  }
  if (o.json != "-") fmt::print("stored in {}\n", tuned_sizes_file().string());
  if (!o.json.empty()) write_json(o.json, json.dump(1));
  return 0;
}

int bench(const BenchCommand& o) {
  RowFilter(o.filter);  // reports a wrong filter before the work
  if (!o.json.empty()) check_output_file("--json", o.json);
  if (o.tune) return tune(o);
  BenchOptions options{.cases = cases_of(o), .contestants = contestants_of(o), .filter = o.filter};
  options.own_tile = !gives_tile(o.set) && !gives_tile(o.compare);
  options.frames = o.timing.frames, options.warmup = o.timing.warmup;
  options.step = progress_bar();
  if (!o.write_frames.empty()) {
    write_frames(o.write_frames, options);
    return 0;
  }
  const bool table = o.json != "-";
  if (table) {
    options.found = [](const std::vector<BenchRow>& rows) {
      for (const BenchRow& row : rows) std::fputs(table_line(row).c_str(), stdout);
      std::fflush(stdout);
    };
  }
  ClDevice device(o.device);
  for (BenchContestant& c : options.contestants) c.settings = with_tuned(c.settings, read_tuned_sizes(device.info()));
  if (table) fmt::print("{}, {}\n{}", device.info().name, device.info().driver, table_head());
  const BenchReport report = run_bench(device, options);
  if (!o.json.empty()) write_json(o.json, to_json(report).dump(1));
  return 0;
}

}  // namespace

void add_bench(CommandLine& line) {
  auto o = std::make_shared<BenchCommand>();
  Subcommand command = line.add("bench", "the culling kernels against the machine's limits", [o] { return bench(*o); });
  command.option("--filter", o->filter, "only rows whose \"CASE/ROW\" matches this regular expression");
  command.list("--replay", o->replay, "a captured frame's folder instead of the standard frames; may be repeated");
  command.option("--write-frames", o->write_frames, "writes the frames of the cases into this folder, and measures nothing");
  command.flag("--tune", o->tune, "finds the fastest kernel shape and sizes, and stores them for this device");
  command.list("--set", o->set, "a setting, KEY=VALUE; may be repeated");
  command.list("--compare", o->compare, "KEY=VALUE,VALUE,…: run in turn, with ratios to the first; may be repeated");
  command.option("--device", o->device, "OpenCL device, by a part of its name");
  add_timing_options(command, o->timing);
  command.option("--json", o->json, "as JSON into a file, - for stdout");
}

}  // namespace lightgrid
