#include "study/frame_culler.h"

#include <numeric>

#include "passes/frame/frame.h"

namespace lightgrid {

Settings frame_settings(const CapturedFrame& frame, const std::vector<std::string>& set) {
  Settings settings;
  settings.tile = frame.tile;
  for (const std::string& assignment : set) apply_setting(settings, assignment);
  return settings;
}

CullerOptions culler_options(const Settings& settings) {
  CullerOptions options;
  options.cull_test = settings.cull_test;
  options.depth_bounds = settings.depth_bounds;
  options.shape = settings.kernel_shape;
  options.tile = settings.tile;
  options.portable = settings.portable;
  return options;
}

std::vector<CullLight> cull_lights_of(const CapturedFrame& frame) {
  Scene scene;
  scene.lights = local_world_lights(frame);
  std::vector<int> all(scene.lights.size());
  std::iota(all.begin(), all.end(), 0);
  return cull_lights_of(scene, all);
}

FrameCuller::FrameCuller(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame,
                         const Settings& settings)
    : device_(device),
      settings_(settings),
      culler_(device, programs, culler_options(settings)),
      storage_(device) {
  culler_.set_lights(cull_lights_of(frame));
  culler_.set_view(cull_view(frame.view));
  const size_t bytes = frame.depth.size() * sizeof(float);
  depth_.values = cl::Buffer(device.context(), CL_MEM_READ_WRITE, bytes);
  device.queue().enqueueWriteBuffer(depth_.values, CL_TRUE, 0, bytes, frame.depth.data());
}

void FrameCuller::run() {
  bounds_ = culler_.depth_bounds(depth_);
  grid_ = culler_.cull(bounds_.opaque, storage_);
}

FrameGrid FrameCuller::grid() {
  FrameGrid grid;
  grid.lists = read_grid(device_, grid_, storage_);
  grid.tile = settings_.tile;
  grid.settings = to_strings(settings_);
  return grid;
}

std::vector<DepthInterval> FrameCuller::intervals() { return culler_.read_bounds(bounds_.opaque); }

}  // namespace lightgrid
