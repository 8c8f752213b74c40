// A captured frame and its grid in one line, and as JSON.
#pragma once

#include <optional>
#include <string>

#include "base/timer.h"
#include "frames/frame_culler.h"

namespace lightgrid::lab {

// "1920x1080, 256 lights, 120x68 cells of 16 pixels, 261120 indices (32.0 a cell, at most 91)"
std::string summary_line(const CapturedFrame& frame, const FrameGrid& grid);

std::string summary_json(const CapturedFrame& frame, const FrameGrid& grid, const std::string& device,
                         const std::optional<Spread>& time = {});

}  // namespace lightgrid::lab
