// Lights made in code.
#pragma once

#include <cstdint>

#include "scene/camera.h"

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

// What shows a scene that brings no lights of its own: two directional lights fixed to the viewer, the key from the
// upper left and a weaker fill from the right, and an ambient term that metal is seen by. White paint that faces the
// viewer comes out at 0.8, the brightest that the tone map keeps as it is.
struct DefaultLights {
  std::vector<Light> lights;
  glm::vec3 ambient{0};
};
DefaultLights default_lights(const View& view);

}  // namespace lightgrid
