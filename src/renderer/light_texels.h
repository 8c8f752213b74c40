// Lights as shaders and kernels read them: four floats each.
#pragma once

#include <vector>

#include "plan/frame_plan.h"

namespace lightgrid {

// View space. Point and spot lights in the order of plan.local, laid out as in shared/punctual_light.h;
// `cones` only if the plan has spots. Two per directional light: direction to the light, and illuminance.
struct LightTexels {
  std::vector<glm::vec4> positions, colors, cones, directional;
};

// What the shading of lights with such ranges is compiled with (shared/punctual_light.h).
std::vector<const char*> range_defines(const LightRanges& ranges);

LightTexels light_texels(const Scene& scene, const View& view, const FramePlan& plan);

}  // namespace lightgrid
