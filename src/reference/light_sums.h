// The sums of light_prepass's light buffer in double (docs/details/light_prepass.md#equations).
#pragma once

#include <span>

#include "scene/view_lights.h"

namespace lightgrid {

struct LightSums {
  glm::dvec3 diffuse{0};                     // channels 1 to 3
  double specular = 0, weight = 0, rim = 0;  // channels 4 to 6
};

// Adds up point and spot lights at a point of a perspective view. normal: unit, view space; exponent: the
// lights'.
// A light at the point itself adds nothing.
LightSums light_sums(const glm::dvec3& position, const glm::dvec3& normal, std::span<const ViewLight> lights,
                     double exponent);

}  // namespace lightgrid
