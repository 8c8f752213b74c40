// The light grid of a captured frame, made by the culler. OpenCL only: nothing here opens OpenGL.
#pragma once

#include "cl/device.h"
#include "cl/program_cache.h"
#include "culling/light_culler.h"
#include "frames/frame_file.h"
#include "plan/settings/grid.h"
#include "run/frames.h"

namespace lightgrid::lab {

// The default settings with the frame's tile size, then each KEY=VALUE of `set`.
Settings frame_settings(const CapturedFrame& frame, const std::vector<std::string>& set);

CullerOptions culler_options(const Settings& settings);

// The grid needs of a technique: slices and z-bins if its plan has them or their number was set by name.
// Throws Error(input) if it shades from no grid.
TechniqueNeeds grid_needs(const std::string& technique, const Settings& settings);

// One slice if the grid has no slices, and one z-bin likewise.
Settings grid_settings(Settings settings, const TechniqueNeeds& needs);

// The frame's view with those slices and z-bins, from the near plane to frame.surfaces_far_m or, if that is
// unknown, to the farthest surface.
CullView cull_view_of(const CapturedFrame& frame, const Settings& settings);

cl::Buffer upload_depth(ClDevice& device, const CapturedFrame& frame);

// Keys of the settings that culling reads.
const std::vector<std::string>& culling_settings();

// The point and spot lights.
std::vector<CullLight> cull_lights_of(const CapturedFrame& frame);

class FrameCuller {
 public:
  // Settings that are not given take the device's tuned values. The setting tile is used, not the frame's
  // own. Uploads depth and lights; the frame may be destroyed afterwards.
  FrameCuller(ClDevice& device, ProgramCache& programs, const CapturedFrame& frame, const Settings& settings,
              const TechniqueNeeds& needs = {});

  // Depth bounds and culling, to the finished grid. Waits.
  void run();

  // Results of the last run.
  FrameGrid grid();
  std::vector<DepthInterval> intervals();  // one a tile, x fastest, then y from the bottom
  uint32_t invalid_depth_tiles() { return culler_.invalid_depth_tiles(); }

 private:
  ClDevice& device_;
  Settings settings_;
  CullView view_;
  LightCuller culler_;
  ClGridStorage storage_;
  DepthInput depth_;
  DepthBounds bounds_;
  LightGrid grid_;
};

}  // namespace lightgrid::lab
