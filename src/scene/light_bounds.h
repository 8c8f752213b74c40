// What a light can reach, whatever its kind: a ball, or the part of it in a cone. Culling, light volumes and
// whatever else must find a light's surfaces start from it.
#pragma once

#include "scene/view_lights.h"

namespace lightgrid {

struct LightBounds {
  glm::dvec3 position{0};                                     // in the light's space
  double radius_m = std::numeric_limits<double>::infinity();  // of 0 or less: it reaches nothing
  glm::dvec3 direction{0, 0, -1};                             // the cone's axis, unit
  double cos_outer = -1;                                      // of the cone's half-angle; -1: the whole ball

  bool has_cone() const { return cos_outer > -1; }
  // Shading rounds the cosine, by less than 10^-6. pi without a cone.
  double widened_angle_rad() const;
};

// World space. The range is that of range_of.
LightBounds bounds_of(const Light& light, double range_m);
// View space.
LightBounds bounds_of(const ViewLight& light);

}  // namespace lightgrid
