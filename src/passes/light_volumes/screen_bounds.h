// Where on the screen, and between which depths, a light may reach anything: rectangles and intervals instead
// of meshes.
#pragma once

#include "passes/light_volumes/light_volumes.h"

namespace lightgrid {

struct ScreenBounds {
  glm::ivec2 first, end;  // pixels: first <= p < end
  glm::vec2 depth{0, 1};  // values of the depth image, ascending
};

// The rectangle is that of the ball's tangents, where it has some, and within the volume's own. The
// interval is the ball's along the view axis, and within the volume's.
ScreenBounds screen_bounds(const View& view, const ViewLight& light, const LightVolume& volume);

}  // namespace lightgrid
