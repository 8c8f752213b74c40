// Lights that move without a rig: functions of time and of the light's index, the same in every run.
#pragma once

#include <string>

#include "scene/animation.h"

namespace lightgrid {

enum class LightMotion {
  none,
  orbit,  // each light circles at constant height, once in 4 to 10 s; its orbit passes through its rest
          // position
  drift,  // each light drifts slowly and smoothly around its rest position, in all directions
};

// "none", "orbit" or "drift"; throws Error(input) for anything else.
LightMotion light_motion(const std::string& name);

// The positions of a scene's lights at time 0.
struct LightRig {
  LightMotion motion = LightMotion::none;
  std::vector<glm::dvec3> positions;  // world, metres; one a light of the scene
};
LightRig make_light_rig(const Scene& scene, LightMotion motion);

// Moves point and spot lights to their positions at `seconds`, exactly to their rest positions at 0, and
// returns those that have changed (SceneChanges::lights). A light stays within 0.4 (orbit) or 0.7 (drift) of
// its radius from its rest position; a radius above 5 m counts as 5 m. Directions stay. Directional lights,
// and lights that a node of the scene's rig moves, are unchanged. The scene must have as many lights as when
// the rig was created. Throws Error(input) for a time that is not finite.
SceneChanges move_lights(Scene& scene, const LightRig& rig, double seconds);

}  // namespace lightgrid
