// The views of a scene on which a frontier measures, and its scene as series vary it.
#pragma once

#include "session/scene_choice.h"

namespace lightgrid {

// `count` views along the camera path; without one, turned about the camera's place. In an order whose every
// prefix is spread over the path.
std::vector<View> frontier_views(const Scene& scene, const View& start, const SceneChoice& choice, int count);

// Frames of a camera that turns from `start` by a quarter of a degree a frame.
std::vector<View> slow_turn(const Scene& scene, const View& start, int frames);

}  // namespace lightgrid
