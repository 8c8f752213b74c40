// Which lights cast shadows, where that is not left to the scene.
#pragma once

#include <cstddef>

#include "scene/scene.h"

namespace lightgrid {

// A light's contribution to a scene of this diameter, whatever the view: its irradiance (brightest channel),
// integrated over the space that it reaches, lux m^3. A point light of intensity I has I / d^2 on a sphere of
// 4 pi d^2, thus 4 pi I times its range; a spot has its cone's share of that; ranges end at the diameter. A
// directional light reaches the ball of that diameter.
double light_importance(const Light& light, double scene_diameter_m);

// The `count` most important lights cast shadows, the others do not. Of equally important lights the first
// do. A count past the number of lights: all of them.
void choose_shadow_casters(Scene& scene, size_t count);

}  // namespace lightgrid
