// One frame with one choice of settings, ready to be culled again and again.
#pragma once

#include <memory>

#include "culling/light_culler.h"
#include "plan/settings.h"
#include "bench/standard_frames.h"
#include "capture/frame_culler.h"

namespace lightgrid {

class CullingRun {
 public:
  // Uploads the lights and runs twice, so that kernels are built and memory has its size. Slices and z-bins are those
  // that were set by name. Runs of one frame share its depth, so that none finds it colder than another does.
  CullingRun(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const cl::Buffer& depth,
             const Settings& settings);

  // Depth bounds, cull and the finished grid, with one wait at the end.
  void run();

  // What a frame may need besides, each with its own wait.
  void upload_lights();
  void download_grid();  // cells and indices into host memory, and masks and z-bins where there are some

  const Settings& settings() const { return settings_; }  // as they count: without slices, one of them
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
