// The geometry of a standard frame: ray distances per pixel, without a renderer.
#pragma once

#include <vector>

#include "scene/random.h"
#include "bench/standard_frames.h"

namespace lightgrid {

// Metres. The camera is at the origin and looks along -z, 60 degrees high.
inline constexpr float room_near = 0.5f, room_far = 100.0f, room_floor = -5.0f, room_back = 95.0f;
inline constexpr float room_tan_y = 0.57735027f;

// The distance along the view axis of the surface at each pixel; row 0 at the bottom.
std::vector<float> room_distances(const FrameRecipe& recipe);

}  // namespace lightgrid
