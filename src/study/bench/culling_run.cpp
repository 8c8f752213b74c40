#include "study/bench/culling_run.h"

#include "scene/view_lights.h"

namespace lightgrid {
namespace {

CullerOptions culler_options(const BenchFrame& frame, const Settings& settings) {
  CullerOptions options;
  options.cull_test = settings.cull_test;
  options.depth_bounds = settings.depth_bounds;
  options.shape = settings.kernel_shape;
  options.tile = settings.tile;
  for (const Light& light : frame.lights) options.spots |= light.type == LightType::spot;
  options.index_bits = frame.lights.size() > 65536 ? 32 : 16;
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
  Scene scene;
  scene.lights = frame.lights;
  culler_->set_lights(lights_in_view(scene, frame.view));
  culler_->set_view(view_params(frame.view, settings.tile, int(frame.lights.size()), 0, glm::vec3(0)));
  for (int i = 0; i < 2; ++i) run();
}

void CullingRun::run() {
  const DepthBounds bounds = culler_->depth_bounds(depth_);
  cl::Buffer opaque = bounds.opaque;
  grid_ = culler_->cull(opaque, storage_);
  device_.queue().finish();
}

}  // namespace lightgrid
