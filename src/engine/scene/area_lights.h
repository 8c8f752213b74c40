// The rectangles of area lights (docs/area_lights.md): properties of spots.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

// Half of the sides, and the direction in which it emits; in the world.
struct LightRectangle {
  glm::dvec3 across, up, direction;
};

bool has_rectangle(const Light& light);
// Only for a light that has one. The height lies along the light's up axis (scene/light_axes.h).
LightRectangle rectangle_of(const Light& light);
double width_of(const Light& light);   // metres
double height_of(const Light& light);  // metres

// Makes it a spot whose cone is the half-space before the rectangle.
void set_rectangle(Light& light, double width_m, double height_m);

}  // namespace lightgrid
