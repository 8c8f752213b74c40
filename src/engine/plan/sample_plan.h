// Samples per pixel (docs/samples.md).
#pragma once

#include "plan/shadow_plan.h"
#include "plan/surface_plan.h"

namespace lightgrid {

struct SampleNeeds {
  int most = 1;        // per pixel, that its passes can take
  bool opengl = true;  // OpenGL on this machine can draw as many as the scene asks for
};

// Sets setting::samples to what the scene asks for, if the technique can draw that. `opengl`: OpenGL draws;
// `stored`: SurfaceNeeds::stored. Throws Error(input) for samples of the settings that shadows cannot have.
void plan_samples(const Scene& scene, const SampleNeeds& needs, bool opengl, bool stored,
                  const SurfacePlan& surfaces, const ShadowPlan& shadows, Settings& settings,
                  Decisions& decisions);

}  // namespace lightgrid
