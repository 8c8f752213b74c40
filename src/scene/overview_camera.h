// A camera for scenes without one.
#pragma once

#include <optional>

#include "scene/scene.h"

namespace lightgrid {

// From a corner above, 60 degrees high, as near as possible with every triangle in an image of this aspect
// (width / height) and a margin: the scene spans nine tenths of the image's width or height and is centred on
// both axes. The caller sets near and far. Without geometry it looks at the origin.
Camera overview_camera(const Scene& scene, double aspect);

// A person's eye in a room, along its greatest length, 60 degrees high; named "room". Walls are front faces on
// nearly all sides, at least 1.5 m away, over a floor. None in a scene below 3 x 2 x 3 m, without such a place,
// or of more than two million triangles. The caller sets near and far.
std::optional<Camera> room_camera(const Scene& scene);

}  // namespace lightgrid
