#include "plan/visibility.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {

Frustum frustum_of(const View& view) {
  // Gribb and Hartmann (2001): the rows of the projection give its planes; here depth is in [0, w], near at
  // w.
  const glm::dmat4 rows = glm::transpose(view.clip_from_view);
  const glm::dvec4 candidates[6] = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1],
                                    rows[3] - rows[1], rows[3] - rows[2], rows[2]};
  Frustum frustum;
  for (const glm::dvec4& plane : candidates) {
    const double length = glm::length(glm::dvec3(plane));
    if (length > 0) frustum.planes[frustum.count++] = plane / length;  // an infinite far plane has no normal
  }
  return frustum;
}

bool may_see_box(const Frustum& frustum, const glm::dmat4& view_from_object, const Aabb& box) {
  if (box.empty()) return false;
  const glm::dvec3 center = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max));
  const glm::dvec3 half = 0.5 * (glm::dvec3(box.max) - glm::dvec3(box.min));
  const glm::dvec3 place(view_from_object * glm::dvec4(center, 1));
  const double away = glm::length(place);
  const glm::dmat3 axes(view_from_object);
  for (int i = 0; i < frustum.count; ++i) {
    const glm::dvec3 normal(frustum.planes[i]);
    const double reach = std::abs(glm::dot(normal, axes[0])) * half.x +
                         std::abs(glm::dot(normal, axes[1])) * half.y +
                         std::abs(glm::dot(normal, axes[2])) * half.z;
    const double distance = glm::dot(normal, place) + frustum.planes[i].w;
    // 1e-6 covers the float rounding of the vertices in the box.
    if (distance < -reach - 1e-6 * (away + reach)) return false;
  }
  return true;
}

double farthest_of_box(const glm::dmat4& view_from_object, const Aabb& box) {
  double farthest = -std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec4 p(corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                       corner & 4 ? box.max.z : box.min.z, 1);
    farthest = std::max(farthest, -(view_from_object * p).z);
  }
  return farthest;
}

bool may_see_sphere(const Frustum& frustum, glm::dvec3 center_view, double radius) {
  for (int i = 0; i < frustum.count; ++i) {
    if (glm::dot(glm::dvec3(frustum.planes[i]), center_view) + frustum.planes[i].w < -radius) return false;
  }
  return true;
}

}  // namespace lightgrid
