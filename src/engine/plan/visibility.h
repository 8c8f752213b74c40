// Tests what a view may see. Conservative: a result "outside" is certain. In double.
#pragma once

#include "scene/camera.h"
#include "scene/scene.h"

namespace lightgrid {

// The view's side and near planes in view space, inward: dot(normal, p) + offset >= 0. The far plane is
// included only if finite.
struct Frustum {
  glm::dvec4 planes[6];
  int count = 0;
};
Frustum frustum_of(const View& view);

bool may_see_box(const Frustum& frustum, const glm::dmat4& view_from_object, const Aabb& box);
double farthest_of_box(const glm::dmat4& view_from_object,
                       const Aabb& box);  // distance along the view axis, metres
bool may_see_sphere(const Frustum& frustum, glm::dvec3 center_view, double radius);

}  // namespace lightgrid
