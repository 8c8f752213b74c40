// Maps of listed lights, listed but unlit ones, and lost ones.
#pragma once

#include <filesystem>
#include <string>

#include "capture/frame_file.h"
#include "results/results.h"

namespace lightgrid {

struct InspectionMaps {
  PairCounts pairs;
  uint64_t covered = 0;                                 // pixels with a surface
  uint32_t top = 1;                                     // end of the scale of the three maps
  std::vector<uint32_t> listed, false_positives, lost;  // lights per pixel, row 0 at the bottom
};

InspectionMaps inspection_maps(const CapturedFrame& frame, const FrameGrid& grid);

// "pairs" as in results.json, and how many pixels show a surface.
std::string inspection_json(const CapturedFrame& frame, const InspectionMaps& maps, const FrameGrid& grid);

// Writes listed.png, false_positives.png and lost.png; creates the folder if missing. Black is 0; the scale
// ends at `top`.
void write_inspection_maps(const std::filesystem::path& folder, const CapturedFrame& frame,
                           const InspectionMaps& maps);

}  // namespace lightgrid
