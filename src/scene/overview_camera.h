// A camera for scenes without one.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

// From a corner above, 60 degrees high, as near as possible with every triangle in an image of this aspect
// (width / height) and a margin: the scene spans nine tenths of the image's width or height and is centred on
// both axes. The caller sets near and far. Without geometry it looks at the origin.
Camera overview_camera(const Scene& scene, double aspect);

}  // namespace lightgrid
