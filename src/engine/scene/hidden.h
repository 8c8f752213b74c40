// Instances and lights that are hidden at the scene's time (KHR_node_visibility): set_time shrinks an
// instance to a point, which covers no pixel, and gives a light a radius of 0. Totals and boxes leave both
// out.
#pragma once

#include "scene/scene.h"

namespace lightgrid {

inline constexpr double hidden_scale = 0x1p-40;  // scale of a hidden instance's matrix

inline bool is_hidden(const Instance& instance) {
  return glm::dmat3(instance.world_from_object) == glm::dmat3(hidden_scale);
}
// No other light has this radius: a range of 0 means none.
inline bool is_hidden(const Light& light) { return light.radius_m == 0; }

struct ShownCounts {
  size_t instances = 0, lights = 0;
};
ShownCounts shown_counts(const Scene& scene);

}  // namespace lightgrid
