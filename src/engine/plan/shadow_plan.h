// The shadows that a frame finds.
#pragma once

#include "plan/light_plan.h"
#include "plan/light_shadows.h"
#include "plan/surface_plan.h"

namespace lightgrid {

struct ShadowNeeds {
  bool asked_for = true;  // by light loops
  // The technique finds those of point and spot lights itself, of so many lights at most; the pass that all
  // techniques share is then left those of directional lights.
  bool own = false;
  size_t max_own = SIZE_MAX;
  const char* found_by = "rays";  // in words
  const char* why_none = "";      // if it is not the view
};

struct ShadowPlan {
  // Some light of the scene casts a shadow: light loops test whether it reaches a point
  // (shared/light_table.h). The same for every view and time, so that a camera that moves compiles nothing.
  bool light_reaches = false;
  bool directional = false;  // as light_reaches, only for directional lights
  bool needed = false;       // shadows of some light must be found in this frame
  bool bytes = false;        // a share of a light may be hidden: a byte per pixel and light, not a bit
  std::vector<LightShadow> casting;  // all lights that cast, in scene order
  // By index into LightPlan::local and then ::directional, 1: of this light. Empty if none is needed.
  std::vector<uint8_t> shadowed;
  // Point and spot lights whose shadows the technique finds itself, likewise by index into `local`; empty if
  // there are none. own: some light of the scene may be one, as light_reaches.
  std::vector<uint8_t> own_shadowed;
  bool own = false;
  const char* found_by = "rays";  // in words
  // The most that lights too dim for a shadow (shadow-threshold) add to any pixel, in steps of the 8-bit
  // display.
  double dim_steps = 0;
};

ShadowPlan plan_shadows(const Scene& scene, const View& view, const ShadowNeeds& needs,
                        const Settings& settings, PlannedInstances instances, const SurfacePlan& surfaces,
                        const LightPlan& lights, Decisions& decisions);
void plan_every_shadow(const Scene& scene, const View& view, const ShadowNeeds& needs,
                       const Settings& settings, const LightPlan& lights, ShadowPlan& shadows);

}  // namespace lightgrid
