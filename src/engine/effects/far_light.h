// For tests: the last frame's volume of far light on the host.
#pragma once

#include "renderer/pass_context.h"
#include "shared/effects/far_light.h"

namespace lightgrid {

struct ReadFarLight {
  FarGrid grid;
  glm::dvec3 origin;               // of the grid's metres, in the world
  std::vector<glm::vec4> moments;  // FAR_PLANES planes, x fastest
};
ReadFarLight read_far_light(PassContext& work);

}  // namespace lightgrid
