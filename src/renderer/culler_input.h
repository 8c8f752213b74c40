// What culling takes, made of a scene and a view of it. Needs no OpenGL.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "plan/frame_plan.h"

namespace lightgrid {

// Without slices; with those and the z-bins of a plan.
CullView cull_view(const View& view);
CullView cull_view(const View& view, const FramePlan& plan);

// The lights `indices` of a scene. World space, metres.
std::vector<CullLight> cull_lights_of(const Scene& scene, std::span<const int> indices);

// The options of a culler that serves a plan.
CullerOptions culler_options(const FramePlan& plan);

}  // namespace lightgrid
