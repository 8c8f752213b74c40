// The standard frames, generated in code. Captured ones: capture/frame_file.h.
#pragma once

#include "capture/frame_file.h"

namespace lightgrid {

// The parameters of a standard frame.
struct FrameRecipe {
  bool spheres = false;  // 600 floating spheres; else a room with boxes on a sloped floor
  int lights = 1024;
  double mean_listed = 32;  // radii are scaled until a tile lists this many (fewer if there are not enough)
  int width = 1920, height = 1080;
};

// The same frame for the same recipe, on every machine. The size changes the pixels alone: lights are placed
// and scaled for 1920x1080, so that a comparison of resolutions uses one scene.
CapturedFrame make_standard_frame(const FrameRecipe& recipe);

}  // namespace lightgrid
