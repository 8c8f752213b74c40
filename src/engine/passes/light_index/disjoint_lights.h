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

  bool operator==(const LightExtent&) const = default;
};

inline constexpr uint32_t no_group = 0xffffffffu;

// For each extent the first of `groups` groups in which it touches no earlier extent, or no_group. Early
// extents are placed first: sort by importance. slots = 2: in which no two of the earlier extents that it
// touches touch each other, so that no point is in three of a group.
std::vector<uint32_t> group_lights(const std::vector<LightExtent>& extents, uint32_t groups,
                                   uint32_t slots = 1);

// Groups that are kept while the lights are at rest, whatever the camera.
class StillLightGroups {
 public:
  // By index into extents, placed in this order.
  const std::vector<uint32_t>& of(std::vector<LightExtent> extents, std::vector<uint32_t> order,
                                  uint32_t groups, uint32_t slots);
  int sorted() const { return sorted_; }  // how often groups were found

 private:
  std::vector<LightExtent> extents_;
  std::vector<uint32_t> order_, groups_;
  int sorted_ = 0;
};

// The round, from 0, in which each may be drawn: its extent touches no other of the round, and all earlier
// extents that it touches have earlier rounds. So lights that share a pixel keep their order, with few
// rounds.
std::vector<uint32_t> draw_rounds(const std::vector<LightExtent>& extents);

}  // namespace lightgrid
