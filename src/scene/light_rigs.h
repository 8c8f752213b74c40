// Lights made in code.
#pragma once

#include <cstdint>

#include "scene/scene.h"

namespace lightgrid {

struct ScatterSettings {
  int count = 256;
  float min_radius_m = 0,
        max_radius_m = 0;  // both 0: chosen so that about eight lights reach a point of surface
  uint64_t seed = 1;
};

// Point lights (one in eight a spot) near surfaces: a triangle by area, a point on it, then up to half a
// radius along its normal. The first n of a larger count are those of the smaller one, for equal radii; same
// on every machine (own integer generator, no library distributions).
std::vector<Light> scatter_lights(const Scene& scene, const ScatterSettings& settings);

}  // namespace lightgrid
