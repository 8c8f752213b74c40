// A camera that moves: the views of an animation's frames.
#pragma once

#include <string>
#include <vector>

#include "scene/camera.h"

namespace lightgrid {

// turn:N    N views: from `start` once around its own place, about the world's y axis.
// dolly:N   N views: from `start` forward, by a quarter of the scene's diagonal in all.
// FILE      JSON, {"keys": [{"eye": [x, y, z], "target": [x, y, z], "fov": degrees}, …], "frames": N}: N views evenly along the
//           keys, linear between neighbours; without "frames" one view a key; fov is vertical, 60 where absent.
// All have the size of `start`, near and far too. World space, metres. Throws Error(input) for another form, N outside
// 1 to 100,000, a file that is not so, and a target at its eye.
std::vector<View> camera_path(const Scene& scene, const View& start, const std::string& path);

}  // namespace lightgrid
