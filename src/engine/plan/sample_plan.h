// Samples per pixel (docs/samples.md).
#pragma once

#include "plan/shadow_plan.h"
#include "plan/surface_plan.h"

namespace lightgrid {

struct SampleNeeds {
  int most = 1;        // samples per pixel that its passes support
  bool opengl = true;  // OpenGL on this machine can draw as many as the scene requests
};

// Sets setting::samples to the number that the scene requests, if the technique can draw that. `opengl`: OpenGL draws;
// `stored`: SurfaceNeeds::stored. Throws Error(input) for samples of the settings that shadows cannot have.
void plan_samples(const Scene& scene, const SampleNeeds& needs, bool opengl, bool stored,
                  const SurfacePlan& surfaces, const ShadowPlan& shadows, Settings& settings,
                  Decisions& decisions);

}  // namespace lightgrid
