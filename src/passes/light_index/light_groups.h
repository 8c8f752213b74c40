// Lights put into groups of which no two touch, so that those of a group may share one channel of an image, or one draw call.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <glm/glm.hpp>

namespace lightgrid {

// What of a light must not touch another's: a ball within a box, or, with an infinite radius, the box.
struct LightExtent {
  glm::dvec3 low, high;
  glm::dvec3 center{0};
  double radius = std::numeric_limits<double>::infinity();
};

inline constexpr uint32_t no_group = 0xffffffffu;

// The first group of `groups` in which each extent touches none that came before it, or no_group. So the first are those
// that find room: give the most important first.
std::vector<uint32_t> group_lights(const std::vector<LightExtent>& extents, uint32_t groups);

// The round in which each may be drawn, from 0: with others that it does not touch, and after all that it touches and that
// come before it. So what shares a pixel keeps its order, and the rounds are few.
std::vector<uint32_t> draw_rounds(const std::vector<LightExtent>& extents);

}  // namespace lightgrid
