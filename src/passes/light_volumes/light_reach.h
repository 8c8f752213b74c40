// Whether a light may reach a box: in double, conservative.
#pragma once

#include "scene/view_lights.h"

namespace lightgrid {

// Axis-aligned in view space.
struct ViewBox {
  glm::dvec3 center, half;
};

ViewBox box_in_view(const glm::dmat4& view_from_object, const Aabb& box);

class LightReach {
 public:
  explicit LightReach(const LightBounds& light);

  // False only if the light adds nothing to any pixel of a surface in the box.
  bool may_reach(const ViewBox& box) const;

 private:
  glm::dvec3 position_, direction_;
  double radius_;
  double cos_, sin_;  // of the cone's half-angle, widened
  bool cone_;         // narrower than 90 degrees
};

}  // namespace lightgrid
