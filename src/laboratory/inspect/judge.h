// Judges the light lists that a frame came with, from any engine: which lights each pixel lacks.
#pragma once

#include "inspect/inspect.h"
#include "measures/picture_pixel.h"

namespace lightgrid::lab {

struct LostLight {
  int light = 0;        // in the frame
  uint64_t pixels = 0;  // where it is lit and not listed
  PicturePixel first;   // row by row from the upper left
  double inside_m = 0;  // largest distance by which such a surface lies within its range
};

struct CellPairs {
  uint32_t cell = 0;
  uint64_t pixels = 0;                     // with a surface
  uint64_t listed = 0, lit = 0, lost = 0;  // (pixel, light) pairs
};

struct Judgement {
  InspectionMaps maps;
  std::vector<LostLight> lost;   // by light
  std::vector<CellPairs> cells;  // with a surface, by number; pixels without a cell count in none
};

Judgement judge(const CapturedFrame& frame, const FrameGrid& grid);

std::string judgement_text(const CapturedFrame& frame, const Judgement& judgement);
std::string judgement_json(const CapturedFrame& frame, const FrameGrid& grid, const Judgement& judgement);
// A test case for each light.
std::string judgement_junit(const CapturedFrame& frame, const Judgement& judgement);

}  // namespace lightgrid::lab
