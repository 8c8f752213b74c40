// Far light: what lights send beyond their ranges, for base lighting (docs/far_light.md).
#pragma once

#include "renderer/work.h"
#include "shared/far_light.h"

namespace lightgrid {

// Fills work.far_light where the plan says so: the volume if the scene's box or a light changed since the
// last frame, its place in the view if the camera moved. Lights of a light group that not all surfaces are in
// keep their ends: the volume's light belongs to no surface.
void fill_far_light(Work& work, Cached<FarLightVolume>& cache);

// The last frame's volume on the host, for tests.
struct ReadFarLight {
  FarGrid grid;
  glm::dvec3 origin;               // of the grid's metres, in the world
  std::vector<glm::vec4> moments;  // FAR_PLANES planes, x fastest
};
ReadFarLight read_far_light(Work& work, Cached<FarLightVolume>& cache);

}  // namespace lightgrid
