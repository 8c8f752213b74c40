// The pixels and depths that a light may reach, as rectangles and intervals instead of meshes.
#pragma once

#include "passes/light_volumes/light_volumes.h"

namespace lightgrid {

struct ScreenBounds {
  glm::ivec2 first, end;  // pixels: first <= p < end
  glm::vec2 depth{0, 1};  // values of the depth image, ascending
};

// The rectangle is bounded by the sphere's tangents, if it has any, and by the volume's rectangle. The
// interval is that of the sphere along the view axis, within the volume's.
ScreenBounds screen_bounds(const View& view, const LightVolume& volume);

}  // namespace lightgrid
