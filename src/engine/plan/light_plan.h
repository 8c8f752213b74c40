// The lights of a frame by kind.
#pragma once

#include <string>

#include "plan/decision.h"
#include "plan/settings.h"
#include "scene/camera.h"
#include "scene/scene.h"
#include "scene/view_lights.h"

namespace lightgrid {

// The point and spot lights that a plan counts as in view. All but the first serve to build in advance, as
// PlannedInstances do: what passes draw depends on the kinds of lights that they see.
enum class PlannedLights { in_view, every, points, spots, none };

struct LightPlan {
  std::vector<int> local, directional;  // light indices by kind, in scene order
  bool any_local = false;               // at least one point or spot light
  bool any_directional = false;
  bool any_virtual = false;  // at least one light is a virtual point light
  bool spots = false;        // compile cone code
  bool in_block = false;     // shaders read them from a uniform block
  int virtual_count = 0;     // of the scene's lights: virtual point lights
  int index_bits = 16;
  PlannedLights planned = PlannedLights::in_view;
  int in_view = 0;  // lights whose range touches the view's frustum
  // By index into `local`, 1: left out, since the view has more than view-cap. Empty: none is.
  std::vector<uint8_t> left_out;
};

LightPlan plan_lights(const Scene& scene, const View& view, const Settings& settings, PlannedLights planned,
                      Decisions& decisions);
void plan_every_light(LightPlan& lights);

// Returns whether the plan counts a point or spot light as in view; in_view: whether it is.
bool counts_as_seen(PlannedLights planned, const ViewLight& light, bool in_view);

std::string light_witness(const Scene& scene, int light);  // for a decision's reason

}  // namespace lightgrid
