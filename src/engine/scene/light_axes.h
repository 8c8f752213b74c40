// The axes of a light: profiles and cookies lie on them. A light stores its direction; the property "up_axis"
// turns it about the direction.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

// Unit vectors, right-handed. The light's node has them as its +x, +y and -z.
struct LightAxes {
  glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, direction{0, 0, -1};
};

// World space. `up` is the part of "up_axis" across the direction. If there is none, `up` is that of a light
// which was tilted about +x: -z for a light that shines down.
LightAxes axes_of(const Light& light);

// Returns whether it turned the light. `up`: world space, of any length.
bool set_up(Light& light, const glm::dvec3& up);

}  // namespace lightgrid
