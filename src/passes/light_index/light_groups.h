// Groups of lights that do not touch, so that a group can share one channel of an image, or one draw call.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// The extent of a light: a sphere within a box or, with an infinite radius, the whole box.
struct LightExtent {
  glm::dvec3 low, high;
  glm::dvec3 center{0};
  double radius = std::numeric_limits<double>::infinity();
};

inline constexpr uint32_t no_group = 0xffffffffu;

// For each extent the first of `groups` groups in which it touches no earlier extent, or no_group. Early
// extents are placed first: sort by importance.
std::vector<uint32_t> group_lights(const std::vector<LightExtent>& extents, uint32_t groups);

// The round, from 0, in which each may be drawn: its extent touches no other of the round, and all earlier
// extents that it touches have earlier rounds. So lights that share a pixel keep their order, with few
// rounds.
std::vector<uint32_t> draw_rounds(const std::vector<LightExtent>& extents);

}  // namespace lightgrid
