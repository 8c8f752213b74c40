// Shadows whose positions are rounded coarsely, since they are far from the origin of shadow rays.
#pragma once

#include <string>

#include "scene/light_ranges.h"
#include "scene/scene.h"

namespace lightgrid {

// A ray hides nothing in its last 1 mm and 2^-20 of its end's distance from the origin (docs/shadows.md).
// Coarse: that is more than 1 cm and a thousandth of the light's range; for a directional light, of an
// instance's diagonal.
struct CoarseShadows {
  int lights = 0, first_light = -1;        // point and spot lights that cast, of the scene
  int instances = 0, first_instance = -1;  // that a directional light casts shadows on
  double gap_m = 0;                        // the largest at any of them
};
CoarseShadows coarse_shadows(const Scene& scene, const LightRanges& ranges);

// "1 light (the first: 7 \"lamp\") is …"; empty without coarse shadows.
std::string describe(const CoarseShadows& coarse, const Scene& scene);

}  // namespace lightgrid
