// The default cases of `lightgrid bench`: culling, and the rasteriser.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/standard_frames.h"

namespace lightgrid {

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

}  // namespace lightgrid
