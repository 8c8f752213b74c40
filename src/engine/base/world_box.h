// A box in world space.
#pragma once

#include <glm/vec3.hpp>

namespace lightgrid {

// Metres, along the world's axes.
struct WorldBox {
  glm::dvec3 min, max;
  bool empty() const { return !(min.x <= max.x); }
};

}  // namespace lightgrid
