// Generated lights.
#pragma once

#include <cstdint>

#include "scene/camera.h"

namespace lightgrid {

struct ScatterSettings {
  int count = 256;
  // Both 0: from the surfaces' area and `ranges_of`, so that about eight lights reach a point of a large
  // plane. Where surfaces lie within each other's reach, as in a building, several times as many do.
  float min_radius_m = 0, max_radius_m = 0;
  uint64_t seed = 1;
  int ranges_of = 0;  // the ranges are those of this many lights; 0: of `count`
};

// Point lights (one in eight a spot) near surfaces: a triangle by area, a point on it, then up to half a
// radius along its normal. With equal radii, n lights are the first n of a larger count. The same on every
// machine (own integer generator, no library distributions).
std::vector<Light> scatter_lights(const Scene& scene, const ScatterSettings& settings);

// Lights for a scene without any: two directional lights fixed to the viewer, the key from the upper left and
// a weaker fill from the right, and an ambient term that makes metal visible. White paint that faces the
// viewer reaches 0.8, the brightest value that the tone map keeps unchanged.
struct DefaultLights {
  std::vector<Light> lights;
  glm::vec3 ambient{0};
};
DefaultLights default_lights(const View& view);

}  // namespace lightgrid
