#include "study/bench/culling_run.h"

#include "passes/frame/frame.h"
#include "study/frame_culler.h"

namespace lightgrid {
namespace {

cl::Buffer upload(ClDevice& device, const std::vector<float>& values) {
  const size_t bytes = values.size() * sizeof(float);
  cl::Buffer buffer(device.context(), CL_MEM_READ_WRITE, bytes);
  device.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, values.data());
  return buffer;
}

}  // namespace

CullingRun::CullingRun(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const Settings& settings)
    : device_(device),
      lights_(cull_lights_of(frame)),
      culler_(std::make_unique<LightCuller>(device, programs, culler_options(settings))),
      storage_(device),
      depth_(upload(device, frame.depth)),
      depth_bytes_(frame.depth.size() * sizeof(float)) {
  upload_lights();
  culler_->set_view(cull_view(frame.view));
  for (int i = 0; i < 2; ++i) run();
}

void CullingRun::run() { grid_ = culler_->cull(culler_->depth_bounds({depth_}).opaque, storage_); }

void CullingRun::upload_lights() {
  culler_->set_lights(lights_);
  device_.queue().finish();
}

void CullingRun::download_grid() {
  host_.resize(grid_.cell_bytes + grid_.index_bytes);
  device_.queue().enqueueReadBuffer(storage_.cells(0), CL_TRUE, 0, grid_.cell_bytes, host_.data());
  if (grid_.index_bytes == 0) return;
  device_.queue().enqueueReadBuffer(storage_.indices(0), CL_TRUE, 0, grid_.index_bytes, host_.data() + grid_.cell_bytes);
}

}  // namespace lightgrid
