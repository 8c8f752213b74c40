#include "scene/light_bounds.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {

double LightBounds::widened_angle_rad() const { return std::acos(std::clamp(cos_outer - 1e-6, -1.0, 1.0)); }

LightBounds bounds_of(const Light& light, double range_m) {
  return {light.position, range_m, glm::normalize(glm::dvec3(light.direction)),
          has_cone(light) ? std::cos(double(light.outer_cone_rad)) : -1.0};
}

LightBounds bounds_of(const ViewLight& light) {
  return {light.position, light.radius_m, light.direction, has_cone(light) ? light.cos_outer : -1.0};
}

}  // namespace lightgrid
