// The motion of a scene along a path.
#pragma once

#include <functional>

#include "scene/animation.h"

namespace lightgrid {

// Moves a scene to frame n of a path, counted from 0, and returns what changed.
using SceneMotion = std::function<SceneChanges(size_t frame)>;

}  // namespace lightgrid
