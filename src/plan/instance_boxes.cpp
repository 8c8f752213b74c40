#include "plan/instance_boxes.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {

using glm::dvec3;

// The world's axis along which an instance has no extent: its mesh's box has none along an object's axis,
// which alone moves a point along the world's. Rounding then moves all points alike, so that even slivers
// stay in the plane. -1: none.
static int flat_axis_of(const glm::dmat4& world_from_object, const Aabb& bounds) {
  for (int object = 0; object < 3; ++object) {
    if (bounds.min[object] != bounds.max[object]) continue;
    for (int world = 0; world < 3; ++world) {
      if (world_from_object[(object + 1) % 3][world] == 0 && world_from_object[(object + 2) % 3][world] == 0)
        return world;
    }
  }
  return -1;
}

bool is_blended(const Scene& scene, int instance) {
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  return scene.materials[size_t(mesh.material)].alpha_mode == AlphaMode::blend;
}

static dvec3 ahead_of(const View& view) { return -glm::transpose(glm::dmat3(view.view_from_world))[2]; }

InstanceBox box_of(const Scene& scene, int instance, const View& view) {
  const glm::dmat4& world_from_object = scene.instances[size_t(instance)].world_from_object;
  const Aabb& bounds = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)].bounds;
  InstanceBox box;
  box.nearest_m = HUGE_VAL, box.farthest_m = -HUGE_VAL;
  box.instance = instance;
  box.blended = is_blended(scene, instance);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                            i & 4 ? bounds.max.z : bounds.min.z, 1);
    const dvec3 at(world_from_object * corner);
    box.min = glm::min(box.min, at), box.max = glm::max(box.max, at);
    const double away_m = glm::dot(ahead_of(view), at - view.eye);
    box.nearest_m = std::min(box.nearest_m, away_m), box.farthest_m = std::max(box.farthest_m, away_m);
  }
  box.flat_axis = flat_axis_of(world_from_object, bounds);
  return box;
}

double distance_to(const InstanceBox& box, const dvec3& point) {
  return glm::length(point - glm::clamp(point, box.min, box.max));
}

double farthest_from(const InstanceBox& box, const dvec3& point) {
  return glm::length(glm::max(glm::abs(box.min - point), glm::abs(box.max - point)));
}

bool may_reach(const GrownLightBounds& reach, const InstanceBox& box) {
  const LightBounds& light = reach.light;
  if (!(light.radius_m > 0) || distance_to(box, light.position) > light.radius_m + reach.slack_m)
    return false;
  if (!light.has_cone()) return true;
  // The box's ball against the cone.
  const dvec3 to = 0.5 * (box.min + box.max) - light.position;
  const double away_m = glm::length(to), radius_m = 0.5 * glm::length(box.max - box.min) + reach.slack_m;
  if (away_m <= radius_m) return true;
  const double cosine = std::clamp(glm::dot(to, light.direction) / away_m, -1.0, 1.0);
  return std::acos(cosine) - std::asin(radius_m / away_m) <= light.widened_angle_rad() + 1e-6;
}

PixelErrors::PixelErrors(const View& view)
    : eye_(view.eye), ahead_(ahead_of(view)), orthographic_(view.orthographic), near_m_(view.near_m) {
  const glm::dmat4& clip = view.clip_from_view;
  across_ = std::hypot(2 / (clip[0][0] * view.width), 2 / (clip[1][1] * view.height)) / 256;
  if (orthographic_) {
    fixed_m_ = (view.far_m - view.near_m) * 0x1p-19;
    return;
  }
  widest_ = std::hypot(1, (1 + std::abs(clip[2][0])) / clip[0][0], (1 + std::abs(clip[2][1])) / clip[1][1]);
  along_ = 0x1p-19 * widest_;
}

// Of the least angle at which the view meets the triangles of the box, at distances along the view up to z.
double PixelErrors::sine_at(const InstanceBox& box, double z) const {
  constexpr double least = 1.0 / 16;
  const int axis = box.flat_axis;
  if (axis < 0) return least;
  const double sine =
      orthographic_ ? std::abs(ahead_[axis]) : std::abs(eye_[axis] - box.min[axis]) / (z * widest_);
  return std::clamp(sine, least, 1.0);
}

double PixelErrors::displaced_m(const GrownLightBounds& reach, const InstanceBox& box) const {
  const double light_m = glm::dot(ahead_, reach.light.position - eye_),
               nearest_m = std::max(box.nearest_m, near_m_),
               z = std::max(nearest_m,
                            std::min(light_m + reach.light.radius_m + reach.slack_m, box.farthest_m));
  const double across_m = (orthographic_ ? 1 : z) * across_ / sine_at(box, z);
  return fixed_m_ + across_m + z * z / nearest_m * along_;
}

}  // namespace lightgrid
