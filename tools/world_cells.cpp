// Measures what the size of the world grid's cells costs: for each world-grid and world-cell the pairs that
// pixels read, memory, and processor time, which other work on the machine changes less than elapsed time.
// Its figures: docs/details/world_grid.md#measured.
//
//     world_cells [SCENE [LIGHTS [WIDTHxHEIGHT [FRAMES]]]]    LIGHTS 0: the scene's own
//     world_cells SCENE LIGHTS steps [WORLD-GRID WORLD-CELL]  each step of a build; also auto
//     world_cells SCENE LIGHTS moved [WORLD-GRID WORLD-CELL]  updates of lights that moved against builds, in
//     turn world_cells SCENE LIGHTS estimates                      what world-cell=auto expects, and its
//     choice
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "accuracy/oracle.h"
#include "passes/common/world_grid_settings.h"
#include "plan/settings/model.h"
#include "renderer/upload/culler_input.h"
#include "run/technique_run.h"
#include "scene/grid_lists.h"
#include "scene/light_rigs.h"
#include "scenes/builtin.h"
#include "world_grid/world_cell.h"

using namespace lightgrid;
using namespace lightgrid::lab;

namespace {

constexpr int builds = 20;

const struct {
  WorldGridShape shape;
  std::string name;
} shapes[] = {
    {WorldGridShape::cubes, "3d"}, {WorldGridShape::columns, "2d"}, {WorldGridShape::hashed, "hashed"}};

// User and system time of all threads.
double processor_ms() {
  rusage used;
  getrusage(RUSAGE_SELF, &used);
  const auto ms = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
  return ms(used.ru_utime) + ms(used.ru_stime);
}

double elapsed_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

void measure(Renderer& renderer, GpuScene& gpu, const View& view, WorldGridShape shape, const char* name,
             double cell, int frames) {
  Settings settings;
  settings.set(setting::world_grid, shape);
  settings.set(setting::world_cell, cell);
  TechniqueRun run(renderer, gpu, view, settings, find_technique("world_grid"));
  run.run_frame(true);
  const LitPairs pairs = count_listed_pairs(run, read_depth(run));
  const double before = processor_ms();
  for (int i = 0; i < frames; ++i) run.run_frame();
  const double frame = (processor_ms() - before) / frames;
  const FramePlan& plan = run.view().plan;
  const std::shared_ptr<SharedWorldGrid> grid =
      gpu.world_grid(renderer, {shape, cell, plan.lights.index_bits, ranges_of(plan.settings)});
  const WorldBox bounds = world_box(gpu.scene());
  const double start = processor_ms();
  std::vector<double> elapsed;
  for (int i = 0; i < builds; ++i) {
    const double from = elapsed_ms();
    grid->build(cull_lights_of(gpu.scene(), plan.lights.local), bounds, view, gpu.lights_version());
    renderer.cl->queue().finish();
    elapsed.push_back(elapsed_ms() - from);
  }
  const double build = (processor_ms() - start) / builds;
  std::ranges::sort(elapsed);
  fmt::print("| `{}` | {} | {:.1f} | {} | {} | {:.2f} | {:.1f} | {:.1f} | {:.0f} |\n", name, cell,
             double(pairs.listed) / double(view.width * view.height), grid->blocks(), grid->entries(),
             double(grid->list_bytes()) * 1e-6, build, elapsed[builds / 2], frame);
  std::fflush(stdout);
}

// The least of many runs, which other work on the machine changes less than a mean, and the median.
struct Elapsed {
  std::vector<double> ms;
  double least() const { return ms.empty() ? 0 : *std::ranges::min_element(ms); }
  double median() const {
    std::vector<double> sorted = ms;
    std::ranges::sort(sorted);
    return sorted.empty() ? 0 : sorted[sorted.size() / 2];
  }
};

Elapsed elapsed_of(int runs, const auto& body) {
  Elapsed elapsed;
  for (int i = 0; i < runs; ++i) {
    const double from = elapsed_ms();
    body();
    elapsed.ms.push_back(elapsed_ms() - from);
  }
  return elapsed;
}

// Kernels by the device's clock, the host's steps by its own: the least of all builds.
void measure_steps(Renderer& renderer, GpuScene& gpu, const View& view, WorldGridShape shape,
                   const char* name, std::optional<double> cell) {
  constexpr int runs = 100;
  const Scene& scene = gpu.scene();
  const FramePlan plan = plan_frame(scene, view, {}, {.lists = {.world_grid = true}});
  const WorldBox bounds = world_box(scene);
  SharedWorldGrid grid(renderer, shape, cell, plan.lights.index_bits);
  SharedWorldGrid of_cl(renderer, shape, cell, plan.lights.index_bits,
                        false);  // without memory that OpenGL shares
  std::vector<CullLight> lights;
  WorldLayout layout;
  const auto build = [&] {
    grid.build(lights, bounds, view, 0);
    renderer.cl->queue().finish();
  };
  const Elapsed of_lights = elapsed_of(runs, [&] { cull_lights_of(scene, plan.lights.local, {}, lights); });
  // In memory of OpenCL first: that build compiles kernels, the second one of the same grid does not.
  const auto build_of = [&](SharedWorldGrid& made) {
    made.build(lights, bounds, view, 0);
    renderer.cl->queue().finish();
  };
  build_of(of_cl);
  SharedWorldGrid again(renderer, shape, cell, plan.lights.index_bits, false);
  const double first_of_cl = elapsed_of(1, [&] { build_of(again); }).least();
  const double first = elapsed_of(1, build).least();
  const Elapsed whole = elapsed_of(runs, build);
  const Elapsed laid_out =
      elapsed_of(runs, [&] { lay_out_world(lights, bounds, shape, cell, world_eye(view), layout); });
  WorldBlockLights blocks;
  const bool counted = has_few_blocks(layout);
  const Elapsed counting = elapsed_of(counted ? runs : 0, [&] { count_world_blocks(layout, blocks); });
  fmt::print(
      "{} {}{}: build {:.2f} ms (median {:.2f}), the first {:.2f}, in OpenCL's memory alone {:.2f}; lights "
      "of "
      "the scene {:.2f}, layout {:.2f}, lights of blocks {:.2f}",
      name, layout.cell, cell ? "" : " (auto)", whole.least(), whole.median(), first, first_of_cl,
      of_lights.least(), laid_out.least(), counting.least());
  ClProfiler& profiler = renderer.cl->profiler();
  std::vector<std::pair<ClProfiler::Row, double>> least;
  profiler.time_launches(true);
  for (int i = 0; i < runs; ++i) {
    build();
    const std::vector<ClProfiler::Row> rows = profiler.collect();
    least.resize(rows.size());
    for (size_t row = 0; row < rows.size(); ++row)
      least[row] = {rows[row], i == 0 ? rows[row].ms : std::min(rows[row].ms, least[row].second)};
  }
  profiler.time_launches(false);
  double kernels = 0;
  for (const auto& [row, ms] : least) {
    kernels += ms;
    fmt::print(", {} {:.2f} ({})", row.label, ms, row.launches);
  }
  fmt::print("; kernels {:.2f}\n", kernels);
  std::fflush(stdout);
}

// Updates where each n-th light moves there and back by half its radius, against builds of the same lights,
// in turn.
void measure_moves(Renderer& renderer, GpuScene& gpu, const View& view, WorldGridShape shape,
                   const char* name, std::optional<double> cell) {
  const Scene& scene = gpu.scene();
  const FramePlan plan = plan_frame(scene, view, {}, {.lists = {.world_grid = true}});
  const WorldBox bounds = world_box(scene);
  std::vector<CullLight> lights = cull_lights_of(scene, plan.lights.local);
  SharedWorldGrid updated(renderer, shape, cell, plan.lights.index_bits, false),
      built(renderer, shape, cell, plan.lights.index_bits, false);
  for (const size_t each : {1000u, 100u, 20u}) {
    std::vector<uint32_t> moved;
    for (size_t i = each / 2; i < lights.size(); i += each) moved.push_back(uint32_t(i));
    updated.build(lights, bounds, view, 0);
    Elapsed of_updates, of_builds;
    for (int i = 0; i < 40; ++i) {
      std::vector<CullLight> now;
      for (const uint32_t m : moved) {
        lights[m].position[i / 2 % 3] += (i % 2 == 0 ? 0.5 : -0.5) * lights[m].radius_m;
        now.push_back(lights[m]);
      }
      const double from = elapsed_ms();
      const bool done = updated.update(moved, now, i);
      const double to = elapsed_ms();
      if (done) of_updates.ms.push_back(to - from);
      if (!done) updated.build(lights, bounds, view, i);
      built.build(lights, bounds, view, i);
      of_builds.ms.push_back(elapsed_ms() - to);
    }
    fmt::print("{} {}: {} of {} lights moved: update {:.2f} ms (median {:.2f}), build {:.2f} ({:.2f})\n",
               name, built.layout().cell, moved.size(), lights.size(), of_updates.least(),
               of_updates.median(), of_builds.least(), of_builds.median());
    std::fflush(stdout);
  }
}

void print_estimates(const GpuScene& gpu, const View& view) {
  const Scene& scene = gpu.scene();
  const FramePlan plan = plan_frame(scene, view, {}, {.lists = {.world_grid = true}});
  const std::vector<CullLight> lights = cull_lights_of(scene, plan.lights.local);
  const WorldBox bounds = world_box(scene);
  constexpr struct {
    WorldGridShape shape;
    const char* name;
  } shapes[] = {
      {WorldGridShape::cubes, "3d"}, {WorldGridShape::columns, "2d"}, {WorldGridShape::hashed, "hashed"}};
  for (const auto& [shape, name] : shapes) {
    for (const double cell : {2.0, 1.0, 0.5, 0.25}) {
      const WorldCellEstimate e = estimate_world_cell(lights, bounds, shape, cell);
      fmt::print("{} {}: {:.1f} listed at a position, {:.0f} entries, {:.0f} blocks\n", name, cell, e.listed,
                 e.entries, e.blocks);
    }
    fmt::print("{} auto: {}\n", name, choose_world_cell(lights, bounds, shape));
  }
}

}  // namespace

int main(int count, char** words) {
  const std::string name = count > 1 ? words[1] : "hall";
  const int lights = count > 2 ? std::atoi(words[2]) : 0;
  int width = 640, height = 360;
  const bool moved = count > 3 && std::string(words[3]) == "moved";
  const bool steps = moved || (count > 3 && std::string(words[3]) == "steps");
  const bool estimates = count > 3 && std::string(words[3]) == "estimates";
  if (count > 3 && !steps && !estimates) std::sscanf(words[3], "%dx%d", &width, &height);
  const int frames = count > 4 ? std::atoi(words[4]) : 3;
  const BuiltinScene* builtin = find_builtin_scene(name);
  if (!builtin) {
    std::fprintf(stderr, "no scene %s\n", name.c_str());
    return 2;
  }
  Scene scene = builtin->make();
  ScatterSettings scatter;
  scatter.count = lights;
  if (lights > 0) scene.lights = scatter_lights(scene, scatter);
  Renderer renderer("", GlBackend::automatic);
  GpuScene gpu(renderer, scene);
  const View view = make_view(scene.cameras.at(0), width, height);
  if (estimates) {
    print_estimates(gpu, view);
    return 0;
  }
  if (steps) {
    for (const std::optional<double> cell : {std::optional<double>(), std::optional(2.0), std::optional(1.0),
                                             std::optional(0.5), std::optional(0.25)}) {
      for (const auto& [shape, shape_name] : shapes) {
        const bool chosen =
            count > 5 && (cell ? *cell == std::atof(words[5]) : words[5] == std::string("auto"));
        const bool wanted = count <= 5 || (shape_name == words[4] && chosen);
        if (wanted)
          (moved ? measure_moves : measure_steps)(renderer, gpu, view, shape, shape_name.c_str(), cell);
      }
    }
    return 0;
  }
  fmt::print(
      "| `world-grid` | `world-cell` | listed a pixel | blocks | entries | MB | build, CPU ms | build, ms | "
      "frame, CPU ms |\n");
  fmt::print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |\n");
  for (const double cell : {2.0, 1.0, 0.5, 0.25}) {
    measure(renderer, gpu, view, WorldGridShape::cubes, "3d", cell, frames);
    measure(renderer, gpu, view, WorldGridShape::columns, "2d", cell, frames);
    measure(renderer, gpu, view, WorldGridShape::hashed, "hashed", cell, frames);
  }
}
