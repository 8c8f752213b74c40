// The rasteriser's cases of `lightgrid bench`: its costs, worked out by hand, and its rows.
#include <gtest/gtest.h>

#include <algorithm>

#include "base/error.h"
#include "bench/bench.h"
#include "bench/runs.h"
#include "plan/settings/kernels.h"
#include "scenes/builtin.h"

namespace lightgrid::lab {
namespace {

TEST(RasterCosts, AreTheBytesThatEachStepCannotAvoid) {
  KernelWork w;
  w.pixels = 1000;
  w.tiles = 6;
  w.vertices = 10;
  w.triangles = 640;
  w.clusters = 4;
  w.records = 3;
  w.tile_entries = 5;
  const auto bytes = [&](const char* label) { return kernel_cost(label, w)->bytes; };
  EXPECT_EQ(bytes("raster_transform"), 10 * (12 + 16));  // a position read, clip space written
  EXPECT_EQ(kernel_cost("raster_transform", w)->flops, 10 * 24);
  EXPECT_EQ(bytes("raster_clusters"), 10 * 64);     // 640 triangles are at least 10 clusters
  EXPECT_EQ(bytes("raster_order"), 10 + 4 * 4);     // their buckets, and the list of those in view
  EXPECT_EQ(bytes("raster_setup"), 3 * (12 + 64));  // corners read, a record written
  EXPECT_EQ(bytes("raster_scan"), 6 * (4 + 4));     // counts read, beginnings written
  EXPECT_EQ(bytes("raster_fill"), 3 * 8 + 5 * 4);   // boxes read, entries written
  EXPECT_EQ(bytes("raster_tiles"), 5 * 4 + 3 * 64 + 1000 * 8);
  EXPECT_EQ(bytes("raster_keys"), 1000 * 16);
  EXPECT_EQ(bytes("raster_clear"), 1000 * 8);
  EXPECT_FALSE(kernel_cost("raster_small", w).has_value());
}

TEST(RasterBench, HasARowForEachKernelWithItsBytes) {
  const Scene scene = find_builtin_scene("spheres")->make();
  size_t vertices = 0, triangles = 0;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    if (scene.materials[mesh.material].alpha_mode == AlphaMode::blend) continue;
    vertices += mesh.positions.size();
    triangles += mesh.indices.size() / 3;
  }
  ClDevice device;
  BenchOptions options{.cases = {{"raster-small", {.width = 200, .height = 100}, {}, 0, "spheres"}},
                       .contestants = {{"", {{setting::kernel_shape, KernelShape::lanes}}}},
                       .filter = "^raster-small/",
                       .frames = 2,
                       .warmup = 1};
  const BenchReport report = run_bench(device, options);
  const auto row = [&](const char* name) -> const BenchRow& {
    return *std::ranges::find(report.rows, std::string(name), &BenchRow::name);
  };
  for (const std::string& name : raster_rows()) {
    const bool of_gpus =
        name == "raster_small" || name == "raster_large" || name == "raster_clear" || name == "raster_keys";
    EXPECT_EQ(std::ranges::count(report.rows, name, &BenchRow::name), of_gpus ? 0 : 1) << name;
  }
  EXPECT_EQ(report.rows.size(), raster_rows().size() - 4);
  const auto& params = row("pipeline").params;
  EXPECT_EQ(params["scene"], "spheres");
  EXPECT_EQ(params["triangles"], triangles);
  EXPECT_GT(params["records"].get<size_t>(), 1000u);
  EXPECT_EQ(row("raster_transform").cost->bytes, double(vertices) * 28);
  EXPECT_EQ(row("raster_scan").cost->bytes, 4 * 2 * 8) << "200 x 100 pixels are 4 x 2 tiles";
  double sum = 0;
  for (const BenchRow& each : report.rows) sum += each.kind == "kernel" ? each.cost->bytes : 0;
  EXPECT_EQ(row("pipeline").cost->bytes, sum);
  EXPECT_EQ(row("pipeline").ms.runs, 2);
}

TEST(RasterBench, RefusesASceneThatDoesNotExist) {
  ClDevice device;
  const BenchOptions options{
      .cases = {{"raster-none", {}, {}, 0, "none"}}, .contestants = {{"", {}}}, .filter = "^raster-none/"};
  EXPECT_THROW(run_bench(device, options), Error);
}

}  // namespace
}  // namespace lightgrid::lab
