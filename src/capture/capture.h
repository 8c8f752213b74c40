// A frame as files, from a scene: depth as every technique with a prepass has it, lights and view.
#pragma once

#include "capture/frame_file.h"
#include "techniques/technique.h"

namespace lightgrid {

// Draws the depth prepass. settings.tile becomes the frame's.
CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings);

}  // namespace lightgrid
