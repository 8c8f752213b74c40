// The requirements of a technique for each part of the plan, and the effects that its light can have.
#pragma once

#include "plan/effect.h"
#include "plan/list_plan.h"
#include "plan/mask_plan.h"
#include "plan/sample_plan.h"
#include "plan/shadow_plan.h"
#include "plan/surface_plan.h"

namespace lightgrid {

struct TechniqueNeeds {
  Effects effects{};
  SurfaceNeeds surfaces{};
  ListNeeds lists{};
  MaskNeeds masks{};
  ShadowNeeds shadows{};
  SampleNeeds samples{};
  // Changes these, and the plan's settings, by the technique's own settings. Null: nothing changes.
  void (*adapt)(TechniqueNeeds& needs, Settings& settings) = nullptr;
};

// Returns whether a technique with these settings draws with OpenGL.
bool draws_with_opengl(const TechniqueNeeds& needs, const Settings& settings);

}  // namespace lightgrid
