// The rasteriser on a scene's opaque and masked triangles, on the OpenCL device that lightgrid would use.
//   raster_frame SCENE.gltf [WIDTHxHEIGHT] [RUNS] [lanes|group|portable] [SAMPLES]
// Prints what was drawn, then least and median milliseconds of each kernel and of the frame. The view is that
// of the repository's benchmarks of Sponza.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <vector>

#include "base/error.h"
#include "base/timer.h"
#include "raster/raster_view.h"
#include "scene/camera.h"
#include "scene/load_gltf.h"

namespace lightgrid {
namespace {

void print_times(const std::string& name, std::vector<double> ms) {
  std::sort(ms.begin(), ms.end());
  fmt::print("  {:18} least {:7.3f}  median {:7.3f}\n", name, ms.front(), ms[ms.size() / 2]);
}

void measure(const char* path, int width, int height, int runs, const RasterOptions& options, int samples) {
  const Scene scene = load_gltf(path);
  ClDevice device;
  ProgramCache programs(device);
  RasterScene geometry(device);
  RasterView raster(geometry, programs, options);
  std::vector<RasterMesh> meshes;
  for (const Mesh& mesh : scene.meshes) meshes.push_back({mesh.positions, mesh.indices});
  std::vector<RasterInstance> instances;
  for (const Instance& instance : scene.instances) {
    const Material& material = scene.materials[scene.meshes[instance.mesh].material];
    if (material.alpha_mode == AlphaMode::blend) continue;
    instances.push_back({.mesh = instance.mesh,
                         .world_from_object = instance.world_from_object,
                         .two_sided = material.double_sided});
  }
  geometry.set_meshes(meshes);
  raster.set_instances(instances);
  const View view = make_view(look_at({-10, 2, 0}, {10, 3, 0}), width, height);
  raster.set_camera({{width, height, samples}, view.clip_from_view, view.view_from_world, view.eye});
  raster.draw();
  raster.draw();

  device.profiler().time_launches(true);
  std::map<std::string, std::vector<double>> kernels;
  std::vector<std::string> order;
  std::vector<double> frames;
  for (int run = 0; run < runs; ++run) {
    const Timer timer;
    raster.draw();
    frames.push_back(timer.elapsed_ms());
    for (const ClProfiler::Row& row : device.profiler().collect()) {
      if (run == 0) order.push_back(row.label);
      kernels[row.label].push_back(row.ms);
    }
  }
  const RasterCounts& counts = raster.counts();
  fmt::print("{}: {} triangles, {} clusters in view, {} records, {} tile entries, {:.1f} MB\n",
             device.info().name, counts.triangles, counts.clusters, counts.records, counts.tile_entries,
             double(geometry.memory_bytes() + raster.memory_bytes()) * 1e-6);
  for (const std::string& name : order) print_times(name, kernels[name]);
  print_times("frame", frames);
}

}  // namespace
}  // namespace lightgrid

int main(int count, char** arguments) {
  int width = 1280, height = 720;
  if (count > 2) std::sscanf(arguments[2], "%dx%d", &width, &height);
  lightgrid::RasterOptions options;
  if (count > 4) {
    options.shape = std::strcmp(arguments[4], "group") == 0 ? lightgrid::KernelShape::group
                                                            : lightgrid::KernelShape::lanes;
    options.portable = std::strcmp(arguments[4], "portable") == 0;
  }
  try {
    if (count < 2)
      throw lightgrid::input_error(
          "raster_frame SCENE.gltf [WIDTHxHEIGHT] [RUNS] [lanes|group|portable] [SAMPLES]");
    lightgrid::measure(arguments[1], width, height, count > 3 ? std::max(1, std::atoi(arguments[3])) : 21,
                       options, count > 5 ? std::atoi(arguments[5]) : 1);
  } catch (const lightgrid::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return error.exit_code();
  }
}
