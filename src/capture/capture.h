// Captures a frame from a scene: the depth of the prepass, lights and view.
#pragma once

#include "capture/frame_file.h"
#include "techniques/technique.h"

namespace lightgrid {

// Draws the depth prepass. settings.tile becomes the frame's tile size.
CapturedFrame capture_frame(Renderer& renderer, const Scene& scene, const View& view, const Settings& settings);

}  // namespace lightgrid
