// The standard frames, made in code. Captured ones: capture/frame_file.h.
#pragma once

#include "capture/frame_file.h"

namespace lightgrid {

// What a standard frame is made of.
struct FrameRecipe {
  bool spheres = false;  // 600 floating spheres; else a room with boxes on a sloped floor
  int lights = 1024;
  double mean_listed = 32;  // radii are scaled until a tile lists as many (fewer, where there are not so many)
  int width = 1920, height = 1080;
};

// The same frame for the same recipe, on every machine. The size changes the pixels alone: lights are placed and
// scaled for 1920x1080, so that a scaling in resolution compares one scene.
CapturedFrame make_standard_frame(const FrameRecipe& recipe);

}  // namespace lightgrid
