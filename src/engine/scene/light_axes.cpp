#include "scene/light_axes.h"

#include <cmath>

namespace lightgrid {

static const Property<glm::dvec3> up_axis{"up_axis", glm::dvec3(0, 1, 0)};

LightAxes axes_of(const Light& light) {
  LightAxes axes;
  axes.direction = glm::normalize(glm::dvec3(light.direction));
  const auto across = [&](const glm::dvec3& up) {
    return up - glm::dot(up, axes.direction) * axes.direction;
  };
  const glm::dvec3 given = up_axis.of(light);
  const double length = glm::length(given);
  glm::dvec3 up = across(length > 0 && std::isfinite(length) ? given / length : glm::dvec3(0, 1, 0));
  if (!(glm::length(up) > 1e-6)) up = across(glm::dvec3(0, 0, axes.direction.y < 0 ? -1 : 1));
  if (!(glm::length(up) > 1e-6)) up = across(glm::dvec3(0, 1, 0));
  axes.up = glm::normalize(up);
  axes.right = glm::cross(axes.direction, axes.up);
  return axes;
}

bool set_up(Light& light, const glm::dvec3& up) {
  constexpr double rounding = 1e-9;
  Light turned = light;
  up_axis.set(turned, up);
  if (glm::length(axes_of(turned).up - axes_of(light).up) < rounding) return false;
  light.properties = std::move(turned.properties);
  return true;
}

}  // namespace lightgrid
