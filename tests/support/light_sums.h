// The values of light buffers in double: the sums of light_prepass (docs/details/light_prepass.md#equations)
// and a sample of a voxel light buffer (docs/details/voxel_lights.md#a-sample).
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "oracle/attenuation.h"
#include "scene/view_lights.h"

namespace lightgrid {
using namespace lab;

struct LightSums {
  glm::dvec3 diffuse{0};                     // channels 1 to 3
  double specular = 0, weight = 0, rim = 0;  // channels 4 to 6
};

// Adds up point and spot lights at a point of a perspective view. normal: unit, view space; exponent: the
// lights'. mask: of the surface.
// A light at the point itself adds nothing.
inline LightSums light_sums(const glm::dvec3& position, const glm::dvec3& normal,
                            std::span<const ViewLight> lights, double exponent, uint32_t mask = full_mask) {
  const glm::dvec3 to_eye = glm::normalize(-position);
  LightSums sums;
  for (const ViewLight& light : lights) {
    const glm::dvec3 offset = light.position - position;
    const double distance = glm::length(offset);
    const glm::dvec3 arrives =
        attenuation(light, position, true) * light_reaches(light, position, mask) * light.radiant_intensity;
    const double brightest = glm::max(arrives.x, glm::max(arrives.y, arrives.z));
    if (!(distance > 0) || !(brightest > 0)) continue;
    const glm::dvec3 to_light = offset / distance;
    const double facing = glm::clamp(glm::dot(normal, to_light), 0.0, 1.0);
    const glm::dvec3 half = to_light + to_eye;
    const double length = glm::length(half);
    const double cosine = length > 0 ? glm::clamp(glm::dot(normal, half) / length, 0.0, 1.0) : 0;
    const double lobe = std::pow(cosine, exponent);
    const double grazing = std::pow(1 - 0.5 * length, 5);  // v.h = |l + v| / 2
    sums.diffuse += facing * (1 - grazing) * arrives;
    sums.specular += facing * lobe * brightest;
    sums.weight += facing * brightest;
    sums.rim += facing * lobe * grazing * brightest;
  }
  return sums;
}

inline constexpr double largest_of_a_light = 1e15;
inline constexpr double longest_radius_m = 7e18;

inline double luminance_of_sample(const glm::dvec3& c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

// The rounded edge of a cone. squared: of the distance.
inline double angular_part(const ViewLight& light, const glm::dvec3& to_light, double squared, double grown) {
  if (!has_cone(light)) return 1;
  const double q = std::min(grown / squared, 4.0);
  const double cosine = squared > 0 ? -glm::dot(light.direction, to_light) / std::sqrt(squared) : 0;
  const double x = cosine - light.cos_outer;
  if (x < -4 * std::sqrt(q)) return 0;
  const double soft = std::sqrt((1 - light.cos_outer * light.cos_outer) * q + q * q / 4);
  const double root = std::hypot(x, soft);
  const double y = x > 0 ? (x + root) / 2 : soft * soft / (2 * (root - x));
  const double t = std::min(y / (light.cos_inner - light.cos_outer), 1.0);
  return (light.max_falloff > 0 ? t : t * t) * (1 - light.cos_outer) / (1 - light.cos_outer + 0.5 * q);
}

struct VoxelSample {
  glm::dvec3 irradiance{0};  // red, green, blue
  glm::dvec3 directions{0};  // sum of directions to lights times their weights
  double weight = 0;         // sum of luminances
  uint64_t lights = 0;       // that add anything
};

// The cell of samples around a sample, metres along the volume's axes: what a light is widened by.
struct VoxelCell {
  double half_diagonal_squared = 0;
  double core_squared = 0;  // 1 / distance^2 is at most 1 / this

  // box: around the cell; volume: of a voxel, m^3.
  static VoxelCell of(const glm::dvec3& box, double volume);
};

inline VoxelCell VoxelCell::of(const glm::dvec3& box, double volume) {
  const double ball = std::cbrt(volume * 3 / (4 * 3.14159265358979323846));
  return {glm::dot(box, box) / 4, ball * ball / 3};
}

// Takes point and spot lights with the window of KHR_lights_punctual. Lights and `at`: along the same axes.
inline VoxelSample voxel_sample(const glm::dvec3& at, const VoxelCell& cell,
                                std::span<const ViewLight> lights) {
  VoxelSample s;
  for (const ViewLight& light : lights) {
    if (is_directional(light) || light.radius_m <= 0) continue;
    const double radius = std::min(light.radius_m, longest_radius_m);
    const glm::dvec3 to_light = light.position - at;
    const double squared = glm::dot(to_light, to_light);
    const double reach = radius * radius + cell.half_diagonal_squared;
    if (squared >= reach) continue;
    const double window = 1 - squared / reach * (squared / reach);
    double falloff = std::min(1 / squared, 1 / cell.core_squared);
    if (light.max_falloff > 0) falloff = std::min(falloff, light.max_falloff);
    const double angular = angular_part(light, to_light, squared, cell.half_diagonal_squared);
    const double arrives = window * falloff * radius / std::sqrt(reach) * angular;
    const glm::dvec3 irradiance = glm::min(arrives * light.radiant_intensity, largest_of_a_light);
    const double weight = luminance_of_sample(irradiance);
    s.irradiance += irradiance;
    s.weight += weight;
    s.lights += arrives > 0;
    if (squared > 0) s.directions += weight * to_light / std::sqrt(squared);
  }
  return s;
}

}  // namespace lightgrid
