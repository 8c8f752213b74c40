#include "bench/runs.h"

#include "cl/transfer.h"
#include "plan/settings/kernels.h"
#include "scene/camera.h"
#include "shared/raster_params.h"

namespace lightgrid::lab {

CullingRun::CullingRun(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame,
                       const cl::Buffer& depth, const Settings& settings)
    : device_(device),
      settings_(grid_settings(settings, grid_needs("forward_plus", settings))),
      lights_(cull_lights_of(frame)),
      culler_(std::make_unique<LightCuller>(device, programs, culler_options(settings_))),
      storage_(device),
      depth_(depth),
      depth_bytes_(frame.depth.size() * sizeof(float)) {
  upload_lights();
  culler_->set_view(cull_view_of(frame, settings_));
  for (int i = 0; i < 2; ++i) run();
}

void CullingRun::run() { grid_ = culler_->cull(culler_->depth_bounds({depth_}).opaque, storage_); }

void CullingRun::upload_lights() {
  culler_->set_lights(lights_);
  finish_queue(device_, "lights");
}

void CullingRun::download_grid() {
  host_.resize(grid_.cell_bytes + grid_.index_bytes + grid_.mask_bytes + grid_.z_bin_bytes);
  char* to = host_.data();
  const auto read = [&](const cl::Buffer& buffer, size_t bytes) {
    read_buffer(device_, "grid", buffer, to, bytes);
    to += bytes;
  };
  read(storage_.cells(0), grid_.cell_bytes);
  read(storage_.indices(0), grid_.index_bytes);
  read(storage_.masks(0), grid_.mask_bytes);
  read(storage_.z_bins(0), grid_.z_bin_bytes);
}

const std::vector<std::string>& raster_rows() {
  static const std::vector<std::string> rows = {
      "raster_transform", "raster_clusters", "raster_order",    "raster_setup",   "raster_scan",
      "raster_fill",      "raster_tiles",    "raster_small",    "raster_large",   "raster_clear",
      "raster_keys",      "pipeline",        "pipeline_device", "launch_overhead"};
  return rows;
}

RasterRun::RasterRun(ClDevice& device, ProgramCache& programs, const Scene& scene, int width, int height,
                     const Settings& settings)
    : geometry_(device),
      raster_(geometry_, programs,
              {.shape = settings[setting::kernel_shape], .portable = settings[setting::portable]}) {
  std::vector<RasterMesh> meshes;
  for (const Mesh& mesh : scene.meshes) meshes.push_back({mesh.positions, mesh.indices});
  std::vector<RasterInstance> instances;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene.meshes[instance.mesh];
    const Material& material = scene.materials[mesh.material];
    if (material.alpha_mode == AlphaMode::blend) continue;
    instances.push_back({.mesh = instance.mesh,
                         .world_from_object = instance.world_from_object,
                         .two_sided = material.double_sided});
    scene_.vertices += mesh.positions.size();
  }
  geometry_.set_meshes(meshes);
  raster_.set_instances(instances);
  const View view = make_view(choose_camera(scene, ""), width, height);
  raster_.set_camera({{width, height}, view.clip_from_view, view.view_from_world, view.eye});
  const auto tiles = [](int pixels) { return (size_t(pixels) + RASTER_TILE - 1) / RASTER_TILE; };
  scene_.pixels = size_t(width) * size_t(height);
  scene_.tiles = tiles(width) * tiles(height);
  for (int i = 0; i < 2; ++i) run();
}

KernelWork RasterRun::work() const {
  const RasterCounts& counts = raster_.counts();
  KernelWork work = scene_;
  work.triangles = counts.triangles;
  work.clusters = counts.clusters;
  work.records = counts.records;
  work.tile_entries = counts.tile_entries;
  return work;
}

}  // namespace lightgrid::lab
