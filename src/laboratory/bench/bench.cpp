#include "bench/bench.h"

#include <algorithm>
#include <cstdlib>

#include "base/error.h"
#include "base/version.h"
#include "bench/runs.h"
#include "plan/settings/cull_test.h"
#include "plan/settings/grid.h"
#include "scenes/builtin.h"
#include "shared/cull_tests.h"

namespace lightgrid::lab {
namespace {

nlohmann::ordered_json machine_of(const ClDeviceInfo& info) {
  const char* threads = std::getenv("POCL_MAX_PTHREAD_COUNT");
  return {{"device", info.name},
          {"platform", info.platform},
          {"vendor", info.vendor},
          {"driver", info.driver},
          {"version", info.version},
          {"cpu", info.cpu},
          {"compute_units", info.compute_units},
          {"pocl_threads", threads ? nlohmann::ordered_json(threads) : nullptr},
          {"commit", commit_of_build()}};
}

nlohmann::ordered_json params_of(const CapturedFrame& frame, const std::string& compared,
                                 const CullingRun& run) {
  const LightGrid& grid = run.grid();
  const double cells = double(grid.cells_x) * grid.cells_y * grid.slices;
  nlohmann::ordered_json params = {{"frame", frame.name},
                                   {"lights", frame.lights.size()},
                                   {"size", {frame.view.width, frame.view.height}},
                                   {"indices", grid.index_count},
                                   {"mean_listed", double(grid.index_count) / cells},
                                   {"settings", to_strings(run.settings())}};
  if (!compared.empty()) params["compared"] = compared;
  return params;
}

KernelWork work_of(const CapturedFrame& frame, const CullingRun& run) {
  constexpr size_t bin = 8;
  const LightGrid& grid = run.grid();
  KernelWork work;
  work.pixels = frame.depth.size();
  work.lights = frame.lights.size();
  work.tiles = size_t(grid.cells_x) * grid.cells_y;
  work.cells = grid.cell_bytes / 8;
  work.bins = ((grid.cells_x + bin - 1) / bin) * ((grid.cells_y + bin - 1) / bin);
  work.indices = grid.index_count;
  work.index_bytes = grid.index_bytes;
  work.mask_bytes = grid.mask_bytes;
  work.z_bins = size_t(run.settings()[setting::z_bins]);
  work.exact = row_of(run.settings()[setting::cull_test]).distance;
  for (const Light& light : frame.lights) work.cones |= has_cone(light);
  return work;
}

// Directional lights are in no list.
CapturedFrame frame_of(const BenchCase& c) {
  if (!c.captured) return make_standard_frame(c.recipe);
  CapturedFrame frame = c.captured();
  frame.lights = local_world_lights(frame);
  return frame;
}

Rounds rounds_of(const BenchOptions& options, const BenchCase& c) {
  Rounds rounds{options.warmup, options.frames, {}};
  if (options.step) rounds.progress = [&](double done) { options.step(done, c.name); };
  return rounds;
}

// The rows of one case, with ratios to those of the first contestant.
std::vector<BenchRow> rows_in_turn(const std::vector<ContestantParams>& about, const MeasuredFrame& measured,
                                   const Limits& limits) {
  std::vector<BenchRow> rows, of_first;
  for (size_t i = 0; i < about.size(); ++i) {
    std::vector<BenchRow> found = contestant_rows(about[i], measured.runs[i], measured, limits);
    for (BenchRow& row : found) {
      const auto first = std::ranges::find(of_first, row.name, &BenchRow::name);
      if (first != of_first.end() && first->ms.median > 0) row.ratio = row.ms.median / first->ms.median;
    }
    const auto times_of_run = [](const MeasuredRun& run) { return FrameTimes{run.wall_ms, run.cpu_ms}; };
    if (i > 0) {
      std::ranges::find(found, "pipeline", &BenchRow::name)->relative =
          relative_frames(times_of_run(measured.runs[i]), times_of_run(measured.runs[0]));
    }
    if (i == 0) of_first = found;
    rows.insert(rows.end(), found.begin(), found.end());
  }
  return rows;
}

// The rows of one case of culling before filtering.
std::vector<BenchRow> measure_case(ClDevice& device, ProgramCache& programs, const BenchOptions& options,
                                   const BenchCase& c, const CapturedFrame& frame, const Limits& limits) {
  std::vector<std::unique_ptr<CullingRun>> runs;
  const cl::Buffer depth = upload_depth(device, frame);
  std::vector<BenchContestant> contestants = options.contestants;
  for (BenchContestant& contestant : contestants) {
    if (c.tile) contestant.settings.set(setting::tile, c.tile);
    if (c.captured && options.own_tile) contestant.settings.set(setting::tile, frame.tile);
    runs.push_back(std::make_unique<CullingRun>(device, programs, frame, depth, contestant.settings));
  }
  const MeasuredFrame measured = measure_in_turn(device, programs, runs, rounds_of(options, c));

  std::vector<ContestantParams> about;
  for (size_t i = 0; i < runs.size(); ++i) {
    about.push_back({c.name, params_of(frame, contestants[i].compared, *runs[i]), work_of(frame, *runs[i])});
  }
  return rows_in_turn(about, measured, limits);
}

// The same of the rasteriser.
std::vector<BenchRow> measure_raster(ClDevice& device, ProgramCache& programs, const BenchOptions& options,
                                     const BenchCase& c, const Limits& limits) {
  const BuiltinScene* builtin = find_builtin_scene(c.raster);
  if (!builtin) throw input_error("bench {}: there is no built-in scene {}", c.name, c.raster);
  const Scene scene = builtin->make();
  std::vector<std::unique_ptr<RasterRun>> runs;
  std::vector<std::function<void()>> work;
  for (const BenchContestant& contestant : options.contestants) {
    runs.push_back(std::make_unique<RasterRun>(device, programs, scene, c.recipe.width, c.recipe.height,
                                               contestant.settings));
    work.push_back([run = runs.back().get()] { run->run(); });
  }
  MeasuredFrame measured;
  measured.runs = time_in_turn(device, work, rounds_of(options, c), [](bool) {});
  std::vector<ContestantParams> about;
  for (size_t i = 0; i < runs.size(); ++i) {
    const KernelWork of_run = runs[i]->work();
    about.push_back({c.name,
                     {{"scene", c.raster},
                      {"size", {c.recipe.width, c.recipe.height}},
                      {"triangles", of_run.triangles},
                      {"clusters", of_run.clusters},
                      {"records", of_run.records},
                      {"tile_entries", of_run.tile_entries},
                      {"settings", to_strings(options.contestants[i].settings)}},
                     of_run});
    if (!options.contestants[i].compared.empty())
      about.back().params["compared"] = options.contestants[i].compared;
  }
  return rows_in_turn(about, measured, limits);
}

// The names of the rows that the contestants will have, from a frame too small to take time.
std::vector<std::string> row_names(ClDevice& device, ProgramCache& programs, const BenchOptions& options) {
  BenchOptions small = options;
  small.frames = 1;
  small.warmup = 0;
  small.step = nullptr;
  const BenchCase tiny{"", {.lights = 4, .width = 64, .height = 36}};
  std::vector<std::string> names;
  Limits none;
  none.operations = 1;
  none.flops.min = 1;
  for (const BenchRow& row :
       measure_case(device, programs, small, tiny, make_standard_frame(tiny.recipe), none)) {
    if (std::find(names.begin(), names.end(), row.name) == names.end()) names.push_back(row.name);
  }
  return names;
}

void keep_rows(BenchReport& report, const BenchOptions& options, const RowFilter& filter,
               std::vector<BenchRow> rows) {
  std::erase_if(rows, [&](const BenchRow& row) { return !filter.keeps(row.case_name, row.name); });
  if (options.found && !rows.empty()) options.found(rows);
  report.rows.insert(report.rows.end(), rows.begin(), rows.end());
}

}  // namespace

BenchReport run_bench(ClDevice& device, const BenchOptions& options) {
  const RowFilter filter(options.filter);
  ProgramCache programs(device);
  const std::vector<std::string> names = row_names(device, programs, options);
  const auto wanted = [&](const BenchCase& c) {
    const std::vector<std::string>& rows = c.raster.empty() ? names : raster_rows();
    return std::any_of(rows.begin(), rows.end(),
                       [&](const std::string& name) { return filter.keeps(c.name, name); });
  };
  BenchReport report;
  report.machine = machine_of(device.info());
  report.device = device.info().name;
  const bool with_large = filter.keeps("limits", "read_large") || filter.keeps("limits", "copy");
  report.limits = measure_limits(device, programs, std::max(options.frames, 10), with_large);
  keep_rows(report, options, filter, limit_rows(report.limits));
  for (const BenchCase& c : options.cases) {
    if (!wanted(c)) continue;
    if (options.step) options.step(0, c.name);
    if (!c.raster.empty()) {
      keep_rows(report, options, filter, measure_raster(device, programs, options, c, report.limits));
      continue;
    }
    const CapturedFrame frame = frame_of(c);
    keep_rows(report, options, filter, measure_case(device, programs, options, c, frame, report.limits));
  }
  if (report.rows.empty()) throw input_error("filter {}: no row's name matches", options.filter);
  return report;
}

void write_frames(const std::filesystem::path& folder, const BenchOptions& options) {
  const RowFilter filter(options.filter);
  for (const BenchCase& c : options.cases) {
    if (!c.raster.empty() || !filter.keeps(c.name, "")) continue;
    if (options.step) options.step(0, c.name);
    write_frame(folder / c.name, frame_of(c));
  }
}

nlohmann::ordered_json to_json(const BenchReport& report) {
  const Limits& l = report.limits;
  const auto rate = [](size_t bytes, const Spread& ms) {
    return ms.runs > 0 ? nlohmann::ordered_json(1e-6 * double(bytes) / ms.min) : nlohmann::ordered_json();
  };
  nlohmann::ordered_json json = {{"machine", report.machine},
                                 {"limits",
                                  {{"read_gb_s", rate(l.large_bytes, l.read_large)},
                                   {"read_depth_gb_s", l.read_depth_gb_s()},
                                   {"copy_gb_s", rate(2 * l.large_bytes, l.copy)},
                                   {"gflop_s", l.gflop_s()},
                                   {"launch_and_wait_ms", l.launch_wait.min},
                                   {"further_launch_ms", l.more_launch.min},
                                   {"to_device_gb_s", rate(l.depth_bytes, l.to_device)},
                                   {"to_host_gb_s", rate(l.depth_bytes, l.to_host)}}},
                                 {"rows", nlohmann::ordered_json::array()}};
  for (const BenchRow& row : report.rows) json["rows"].push_back(to_json(row, report.device));
  return json;
}

}  // namespace lightgrid::lab
