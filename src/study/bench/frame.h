// A frame to measure culling on: a view, its depth and its lights.
#pragma once

#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid {

struct BenchFrame {
  std::string name;  // "floor", "spheres", or the folder that was read
  View view;
  std::vector<Light> lights;  // world space
  std::vector<float> depth;   // z/w of clip_from_view, row 0 at the bottom
  double mean_listed = 0;     // of the lights, per tile of 16 pixels at 1920x1080; 0: unknown
};

// What a standard frame is made of.
struct FrameRecipe {
  bool spheres = false;  // 600 floating spheres; else a room with boxes on a sloped floor
  int lights = 1024;
  double mean_listed = 32;  // radii are scaled until a tile lists as many (fewer, where there are not so many)
  int width = 1920, height = 1080;
};

// The same frame for the same recipe, on every machine. The size changes the pixels alone: lights are placed and
// scaled for 1920x1080, so that a scaling in resolution compares one scene.
BenchFrame make_standard_frame(const FrameRecipe& recipe);

}  // namespace lightgrid
