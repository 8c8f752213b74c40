// One frame with one set of settings, for repeated culling.
#pragma once

#include <memory>

#include "culling/light_culler.h"
#include "plan/settings.h"
#include "bench/standard_frames.h"
#include "capture/frame_culler.h"

namespace lightgrid {

class CullingRun {
 public:
  // Uploads the lights and runs twice, so that kernels are built and memory has its size. Slices and z-bins
  // are used only if set by name. Runs of one frame share its depth, so that the cache is equally warm for
  // all.
  CullingRun(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const cl::Buffer& depth,
             const Settings& settings);

  // Depth bounds, cull and the finished grid, with one wait at the end.
  void run();

  // Other transfers that a frame may need, each with its own wait.
  void upload_lights();
  void download_grid();  // cells and indices into host memory, and masks and z-bins if there are any

  const Settings& settings() const { return settings_; }  // as used: one slice if the grid has none
  const LightGrid& grid() const { return grid_; }
  const cl::Buffer& depth() const { return depth_; }
  size_t depth_bytes() const { return depth_bytes_; }

 private:
  ClDevice& device_;
  Settings settings_;
  std::vector<CullLight> lights_;
  std::unique_ptr<LightCuller> culler_;
  ClGridStorage storage_;
  cl::Buffer depth_;
  size_t depth_bytes_ = 0;
  LightGrid grid_;
  std::vector<char> host_;
};

}  // namespace lightgrid
