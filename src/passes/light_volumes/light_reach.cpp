#include "passes/light_volumes/light_reach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightgrid {
namespace {

// Bounds the float rounding of vertices, depth, lights and positions together: under 1e-5 of the distances.
// 1/256 of the radius is for depth across triangles seen edge-on, which has no useful bound (as in
// light_volumes.cpp).
constexpr double rounding = 1e-5, of_radius = 1.0 / 256;

double sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

ViewBox box_in_view(const glm::dmat4& view_from_object, const Aabb& box) {
  const glm::dvec3 center = 0.5 * (glm::dvec3(box.min) + glm::dvec3(box.max)),
                   half = glm::dvec3(box.max) - center;
  const glm::dmat3 axes(view_from_object);
  return {glm::dvec3(view_from_object * glm::dvec4(center, 1)),
          glm::abs(axes[0]) * half.x + glm::abs(axes[1]) * half.y + glm::abs(axes[2]) * half.z};
}

LightReach::LightReach(const LightBounds& light)
    : position_(light.position), direction_(light.direction), radius_(light.radius_m) {
  const double angle = light.widened_angle_rad();
  cone_ = angle < std::numbers::pi / 2;
  cos_ = std::cos(angle), sin_ = std::sin(angle);
}

bool LightReach::may_reach(const ViewBox& box) const {
  if (!(radius_ > 0)) return false;  // radius 0 lights nothing
  const double slack = rounding * (sum(position_) + sum(box.center) + sum(box.half));
  const double reach = radius_ * (1 + rounding + of_radius) + slack;
  const glm::dvec3 from_light = box.center - position_;
  const glm::dvec3 outside = glm::max(glm::abs(from_light) - box.half, 0.0);
  if (glm::dot(outside, outside) > reach * reach) return false;
  if (!cone_) return true;
  // The sphere around the box against the cone's side: the distance from it, negative inside. An apex in the
  // sphere passes.
  const double ball = glm::length(box.half) + slack + of_radius * std::min(radius_, 1e30);
  const double along = glm::dot(from_light, direction_);
  const double across = std::sqrt(std::max(glm::dot(from_light, from_light) - along * along, 0.0));
  return cos_ * across - sin_ * along <= ball;
}

}  // namespace lightgrid
