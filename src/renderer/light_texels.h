// Lights as shaders and kernels read them: four floats each.
#pragma once

#include <vector>

#include "plan/frame_plan.h"

namespace lightgrid {

// View space. Point and spot lights in the order of plan.local as shared/punctual_light.h has them; `cones` only where the
// plan has spots. Directional lights two each: direction to the light, and illuminance.
struct LightTexels {
  std::vector<glm::vec4> positions, colors, cones, directional;
};

LightTexels light_texels(const Scene& scene, const View& view, const FramePlan& plan);

}  // namespace lightgrid
