// Lights as the kernels read them: kernels/common/light_arrays.h.
#pragma once

#include <span>
#include <vector>

#include "culling/light_culler.h"

namespace lightgrid {

constexpr int world_arrays = 8;
constexpr float far_away = 1e18f;  // as kernels/common/project.h
constexpr double half_ulp = 0x1p-24;

// A light farther than this from the origin (metres) is uploaded as its image under a scaling towards the
// origin: docs/hard_cases.md#far-lights.
constexpr double farthest_light = 1e16;
// Surfaces farther than this from the eye (metres) are in cells that span every distance.
constexpr double farthest_surface = 1e15;

// Positions are uploaded in float, relative to an origin, so each is off by half an ulp of its distance from
// that origin.
struct LightOrigin {
  // World, metres. Empty: no fixed origin serves all lights, and positions must be uploaded relative to the
  // eye, again whenever it moves.
  std::optional<glm::dvec3> fixed;
  // The largest rounding of a fixed-origin spot's position, metres: cones are tested with that much more
  // slack. Radii are grown on upload instead.
  double cone_slack_m = 0;
};

// The fixed origin is the median light. It serves as long as the rounding stays small beside the lights'
// radii: at most 1/256 of the radius for 63 of 64 lights, and for every spot at most 1/256 of the median
// spot's radius.
LightOrigin choose_origin(std::span<const CullLight> lights);

// world_arrays arrays of `stride` floats, relative to `origin`; those past the last light are listed nowhere.
// `eye_reach`: how far the eye may be from the origin, metres.
std::vector<float> light_arrays(std::span<const CullLight> lights, const glm::dvec3& origin, double eye_reach,
                                size_t stride);

}  // namespace lightgrid
