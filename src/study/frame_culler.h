// The light grid of a captured frame, made by the culler. OpenCL only: nothing here opens OpenGL.
#pragma once

#include "cl/device.h"
#include "cl/program_cache.h"
#include "culling/light_culler.h"
#include "plan/settings.h"
#include "study/frame_file.h"

namespace lightgrid {

// The default settings with the frame's tile size, then each KEY=VALUE of `set`.
Settings frame_settings(const CapturedFrame& frame, const std::vector<std::string>& set);

CullerOptions culler_options(const Settings& settings);

// Of the point and spot lights.
std::vector<CullLight> cull_lights_of(const CapturedFrame& frame);

class FrameCuller {
 public:
  // settings.tile decides, not the frame's own. Uploads depth and lights; the frame may go then.
  FrameCuller(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const Settings& settings);

  // Depth bounds and cull, to the finished grid.
  void run();

  // Of the last run.
  FrameGrid grid();
  std::vector<DepthInterval> intervals();  // a tile each, x fastest, then y from the bottom
  uint32_t strange_tiles() { return culler_.strange_tiles(); }

 private:
  ClDevice& device_;
  Settings settings_;
  LightCuller culler_;
  ClGridStorage storage_;
  DepthInput depth_;
  DepthBounds bounds_;
  LightGrid grid_;
};

}  // namespace lightgrid
