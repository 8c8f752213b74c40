// The default cases of `lightgrid bench`.
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
};

// The standard frames, then scaling in lights, tile size and resolution.
std::vector<BenchCase> standard_cases();

}  // namespace lightgrid
