// A camera for scenes that have none.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

// From a corner above, 60 degrees high, as near as keeps every triangle in an image of this aspect (width / height) with a
// margin: what is seen spans nine tenths of the image's width or height and is centred on both axes. Near and far are
// the caller's to set. Without geometry it looks at the origin.
Camera overview_camera(const Scene& scene, double aspect);

}  // namespace lightgrid
