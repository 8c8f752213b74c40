// The fraction of a light's intensity that arrives at a point (KHR_lights_punctual), in double.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/view_lights.h"

namespace lightgrid::lab {

inline double length_of(double x, double y, double z) { return std::sqrt(x * x + y * y + z * z); }

// Cosine between the spot's direction and the direction from the light to the point at `offset` from it. 0 at
// the light itself, as in the shaders, whose vector to the light is zero there.
inline double cos_from_axis(const ViewLight& light, const glm::dvec3& offset, double distance) {
  const double along =
      offset.x * light.direction.x + offset.y * light.direction.y + offset.z * light.direction.z;
  return along / std::max(distance, std::numeric_limits<double>::min());
}

// Points and spots: window / (d^2 p), where the window is clamp(1 - (d / radius)^4, 0, 1), its square, or 1
// inside the radius (scene/light_ranges.h), and p the probability of reaching that far if the radius is a
// random one, else 1. Both are 1 without `window` and for an infinite radius; spots times t^2, t = clamp((cos
// - cos_outer) / (cos_inner - cos_outer), 0, 1). Directional lights: 1. Positive exactly where is_lit holds,
// if `window` is set. Finite: at the light itself d^2 is the smallest normal double.
double attenuation(const ViewLight& light, const glm::dvec3& position, bool window);

inline bool has_hard_edge(const ViewLight& light) {
  return has_cone(light) && light.cos_inner - light.cos_outer < softest_edge / 2;
}

// Returns whether rounding in shading may put a point on the other side of a hard edge: cosines round by less
// than 10^-6, positions of points and lights by up to 8u of their distances from the eye.
inline bool is_near_hard_edge(const ViewLight& light, const glm::dvec3& position) {
  const glm::dvec3 offset = position - light.position;
  const double distance = length_of(offset.x, offset.y, offset.z);
  const double off = 1e-6 * distance + 0x1p-21 * (glm::length(position) + glm::length(light.position));
  return std::abs(cos_from_axis(light, offset, distance) - light.cos_outer) * distance <= off;
}

// The share of a light that reaches a point of a surface with this mask besides that, 0 to 1 for each colour: the
// oracle of light_reaches in shared/light_table.h. Shadows are not part of it, since they depend on the triangle
// that a pixel shows: count_pairs and shade_pixels take them from the oracle of shadows (seen_pairs.h).
inline glm::dvec3 light_reaches(const ViewLight& light, const glm::dvec3& position, uint32_t mask) {
  bool meet = false;
  for (int bit = 0; bit < 32; ++bit) {
    const bool has_light = light.mask >> bit & 1, has_surface = mask >> bit & 1;
    meet = meet || (has_light && has_surface);
  }
  glm::dvec3 share(meet ? 1 : 0);
  if (!light.reach) return share;
  const glm::dvec3 from_light = is_directional(light) ? light.direction : position - light.position;
  for (const ReachTerm& reach : *light.reach) share *= reach(from_light, mask);
  return share;
}

}  // namespace lightgrid::lab
