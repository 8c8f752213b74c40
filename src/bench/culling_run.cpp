#include "bench/culling_run.h"

#include "cl/transfer.h"

namespace lightgrid {

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

}  // namespace lightgrid
