#include "study/bench/culling_run.h"

#include <numeric>

#include "passes/frame/frame.h"

namespace lightgrid {
namespace {

CullerOptions culler_options(const BenchFrame& frame, const Settings& settings) {
  CullerOptions options;
  options.cull_test = settings.cull_test;
  options.depth_bounds = settings.depth_bounds;
  options.shape = settings.kernel_shape;
  options.tile = settings.tile;
  options.portable = settings.portable;
  return options;
}

cl::Buffer upload(ClDevice& device, const std::vector<float>& values) {
  const size_t bytes = values.size() * sizeof(float);
  cl::Buffer buffer(device.context(), CL_MEM_READ_WRITE, bytes);
  device.queue().enqueueWriteBuffer(buffer, CL_TRUE, 0, bytes, values.data());
  return buffer;
}

}  // namespace

CullingRun::CullingRun(ClDevice& device, ProgramCache& programs, const BenchFrame& frame, const Settings& settings)
    : device_(device),
      culler_(std::make_unique<LightCuller>(device, programs, culler_options(frame, settings))),
      storage_(device),
      depth_(upload(device, frame.depth)),
      depth_bytes_(frame.depth.size() * sizeof(float)) {
  std::vector<int> all(frame.lights.size());
  std::iota(all.begin(), all.end(), 0);
  Scene scene;
  scene.lights = frame.lights;
  culler_->set_lights(cull_lights_of(scene, all));
  culler_->set_view(cull_view(frame.view));
  for (int i = 0; i < 2; ++i) run();
}

void CullingRun::run() {
  grid_ = culler_->cull(culler_->depth_bounds({depth_}).opaque, storage_);
}

}  // namespace lightgrid
