// A moving camera: the views of an animation's frames.
#pragma once

#include <string>
#include <vector>

#include "scene/camera.h"

namespace lightgrid {

// turn:N    N views: `start` turned once around its own position, about the world's y axis.
// dolly:N   N views: `start` moved forward, by a quarter of the scene's diagonal in all.
// FILE      JSON, {"keys": [{"eye": [x, y, z], "target": [x, y, z], "fov": degrees}, …], "frames": N}: N
//           views evenly along the keys, linear between neighbours; without "frames" one view a key; fov is
//           vertical, default 60.
// All have the size, near and far of `start`. World space, metres. Throws Error(input) for another form, N
// outside 1 to 100,000, an invalid file or an unknown field, and a target at its eye.
std::vector<View> camera_path(const Scene& scene, const View& start, const std::string& path);

// The same of the text of such a file; `path`: its name in errors.
std::vector<View> camera_path_of_keys(const View& start, const std::string& text, const std::string& path);

}  // namespace lightgrid
