// The share of lights that effects (plan/effect.h) let through, in double: the oracle of their hook
// NAME_reach (shared/inputs.h), and bounds for the code that reads lights outside of light loops.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "scene/light_ranges.h"

namespace lightgrid {

// The part of a light, 0 to 1, that passes to the point at `from_light`, metres from the light, of a surface
// in these groups. Directional lights have no place: `from_light` is then where their light travels to, of
// length 1.
using ReachTerm = std::function<double(const glm::dvec3& from_light, uint32_t groups)>;
using ReachTerms = std::shared_ptr<const std::vector<ReachTerm>>;  // null: none

// Bounds of a ReachTerm, for all points.
struct LightShare {
  double largest = 1;
  bool of_surface = false;  // it is not the same for all surfaces
};

// The hook NAME_reach. It may read the scene and the settings that are stored with ranges
// (SettingFlags::of_lights).
struct ReachOracle {
  // An empty function: all of the light passes. Directions are along the axes of `from_world`. The function
  // is called while the scene is unchanged.
  ReachTerm (*term)(const Scene&, const Light&, const LightRanges&, const glm::dmat3& from_world) = nullptr;
  LightShare (*share)(const Scene&, const Light&, const LightRanges&) = nullptr;
};

// Registers the oracles of a program's effects: once, before any light is read.
void set_reach_oracles(std::vector<ReachOracle> oracles);

ReachTerms reach_terms(const Scene& scene, const Light& light, const LightRanges& ranges,
                       const glm::dmat3& from_world);
// The share that all effects together let through.
LightShare share_of(const Scene& scene, const Light& light, const LightRanges& ranges);

}  // namespace lightgrid
