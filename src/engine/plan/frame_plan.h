// The requirements of this scene, view and settings for a frame, and their reasons. A pure function: features
// that the plan does not name are not compiled, allocated or run. Each part stands in a file of its own, with
// the function that decides it.
#pragma once

#include <string>
#include <vector>

#include "plan/technique_needs.h"

namespace lightgrid {

// In the order in which parts are decided.
struct FramePlan {
  Settings settings;
  bool opengl = true;  // OpenGL draws the surfaces; else OpenCL does
  SurfacePlan surfaces;
  LightPlan lights;
  std::vector<const Effect*> effects;  // that the frame needs
  ListPlan lists;
  MaskPlan masks;
  ShadowPlan shadows;
  bool stencil = false;  // 8 bits next to depth
  bool reversed_triangles = false;
  Decisions decisions;
};

FramePlan plan_frame(const Scene& scene, const View& view, const Settings& settings, TechniqueNeeds needs,
                     PlannedInstances instances = PlannedInstances::in_view,
                     PlannedLights lights = PlannedLights::in_view);

// The plan as `lightgrid plan` prints it.
std::string describe(const FramePlan& plan, const Scene& scene);

}  // namespace lightgrid
