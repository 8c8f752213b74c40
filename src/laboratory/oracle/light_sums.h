// The values of light buffers in double: the sums of light_prepass (docs/details/light_prepass.md#equations)
// and a sample of a voxel light buffer (docs/details/voxel_lights.md#a-sample).
#pragma once

#include <span>

#include "scene/view_lights.h"

namespace lightgrid {

struct LightSums {
  glm::dvec3 diffuse{0};                     // channels 1 to 3
  double specular = 0, weight = 0, rim = 0;  // channels 4 to 6
};

// Adds up point and spot lights at a point of a perspective view. normal: unit, view space; exponent: the
// lights'. groups: of the surface.
// A light at the point itself adds nothing.
LightSums light_sums(const glm::dvec3& position, const glm::dvec3& normal, std::span<const ViewLight> lights,
                     double exponent, uint32_t groups = all_groups);

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

// Takes point and spot lights with the window of KHR_lights_punctual. Lights and `at`: along the same axes.
VoxelSample voxel_sample(const glm::dvec3& at, const VoxelCell& cell, std::span<const ViewLight> lights);

}  // namespace lightgrid
