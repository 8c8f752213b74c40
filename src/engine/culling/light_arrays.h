// Lights as the kernels read them: kernels/culling/light_arrays.h.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "culling/light_culler.h"
#include "shared/cull_constants.h"

namespace lightgrid {

constexpr int world_arrays = 8;
constexpr float far_away = FAR_AWAY;
constexpr double half_ulp = 0x1p-24;

// A light farther than this from the origin (metres) is uploaded scaled towards the origin:
// docs/details/hard_cases.md#far-lights.
constexpr double farthest_light = 1e16;
// Surfaces farther than this from the eye (metres) are in cells that span every distance.
constexpr double farthest_surface = 1e15;

// Positions are uploaded in float, relative to an origin, so each is off by half an ulp of its distance from
// that origin.
struct LightOrigin {
  // World, metres. Empty: no fixed origin is accurate enough for all lights; positions must be uploaded
  // relative to the eye, again whenever it moves.
  std::optional<glm::dvec3> fixed;
  // The largest rounding of a spot's position with the fixed origin, metres in view space: added to the slack
  // of cone tests. Radii are grown on upload instead.
  double cone_slack_m = 0;
};

// The fixed origin is the median light. It is used if the rounding stays small compared with the lights'
// radii: at most 1/256 of the radius for 63 of 64 lights, and for every spot at most 1/256 of the median
// spot's radius.
LightOrigin choose_origin(std::span<const CullLight> lights);

// world_arrays arrays of `stride` floats, relative to `origin`; the padding is listed nowhere. `eye_reach`:
// the largest distance of the eye from the origin, metres.
std::vector<float> light_arrays(std::span<const CullLight> lights, const glm::dvec3& origin, double eye_reach,
                                size_t stride);

}  // namespace lightgrid
