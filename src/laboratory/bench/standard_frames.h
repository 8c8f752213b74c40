// The standard frames, generated in code, and the default cases of `lightgrid bench`: culling, and the
// rasteriser. Captured frames: frames/frame_file.h.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "frames/frame_file.h"

namespace lightgrid::lab {

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

struct BenchCase {
  std::string name;  // "floor-4096", "lights-100", "tile-8", "size-3840x2160"; of a captured frame: its
                     // folder's name
  FrameRecipe recipe;
  std::function<CapturedFrame()> captured{};  // called when the case runs; empty: the recipe
  int tile = 0;                               // the case's own tile size; 0: from the settings
  std::string
      raster{};  // a built-in scene: its triangles are drawn, at the recipe's size, instead of culling
};

// The standard frames, then scaling in lights, tile size and resolution; then the rasteriser.
std::vector<BenchCase> standard_cases();

}  // namespace lightgrid::lab
