// The culler's input for a scene and a view of it. Needs no OpenGL.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "plan/frame_plan.h"

namespace lightgrid {

// Without slices; with the plan: with its slices and z-bins.
CullView cull_view(const View& view);
CullView cull_view(const View& view, const FramePlan& plan);

CullLight cull_light(const LightBounds& bounds);
// The lights of a scene at `indices`. World space, metres.
std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices,
                                      const LightRanges& ranges = {});
// The same, into memory that is kept.
void cull_lights_of(const Scene& scene, std::span<const int> indices, const LightRanges& ranges,
                    std::vector<CullLight>& lights);

// The culler options of a plan.
CullerOptions culler_options(const FramePlan& plan);

}  // namespace lightgrid
