// Where over the image lights are listed, listed in vain, and lost.
#pragma once

#include <filesystem>
#include <string>

#include "capture/frame_file.h"
#include "results/results.h"

namespace lightgrid {

struct InspectionMaps {
  PairCounts pairs;
  uint64_t covered = 0;                                 // pixels with a surface
  uint32_t top = 1;                                     // where the scale of the three maps ends
  std::vector<uint32_t> listed, false_positives, lost;  // lights per pixel, row 0 at the bottom
};

InspectionMaps inspection_maps(const CapturedFrame& frame, const FrameGrid& grid);

// "pairs" as in results.json, and how many pixels show a surface.
std::string inspection_json(const CapturedFrame& frame, const InspectionMaps& maps, const FrameGrid& grid);

// listed.png, false_positives.png and lost.png into the folder, made where it is missing: black is 0, then up
// to `top`.
void write_inspection_maps(const std::filesystem::path& folder, const CapturedFrame& frame,
                           const InspectionMaps& maps);

}  // namespace lightgrid
