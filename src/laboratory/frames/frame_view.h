// view.json: the view of a captured frame.
#pragma once

#include <filesystem>
#include <string>

#include "scene/camera.h"

namespace lightgrid::lab {

inline constexpr int max_frame_side = 16384;  // pixels

struct FrameView {
  View view;
  int tile = 16;
  double surfaces_far_m = 0;  // CapturedFrame's
};

// Throws Error(input) unless the view is perspective or orthographic along -z with depth from zero to one.
FrameView read_view_file(const std::filesystem::path& path);
std::string view_file_text(const FrameView& frame);

}  // namespace lightgrid::lab
