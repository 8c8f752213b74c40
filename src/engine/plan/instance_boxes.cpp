#include "plan/instance_boxes.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {

using glm::dvec3;

// The world's axis along which an instance has no extent: its mesh's box has none along an object's axis,
// which alone moves a point along the world's. Rounding then moves all points alike, so that even slivers
// stay in the plane.
struct FlatAxes {
  int object = -1, world = -1;  // -1: none
};

static FlatAxes flat_axes_of(const glm::dmat3& world_from_object, const Aabb& bounds) {
  for (int object = 0; object < 3; ++object) {
    if (bounds.min[object] != bounds.max[object]) continue;
    for (int world = 0; world < 3; ++world) {
      if (world_from_object[(object + 1) % 3][world] == 0 && world_from_object[(object + 2) % 3][world] == 0)
        return {object, world};
    }
  }
  return {};
}

// Upper bound on the factor by which a matrix stretches; exact for axes at right angles.
static double max_stretch(const glm::dmat3& m) {
  const glm::dmat3 squares = glm::transpose(m) * m;
  double most = 0;
  for (int i = 0; i < 3; ++i) most = std::max(most, glm::dot(glm::abs(squares[i]), dvec3(1)));
  return std::sqrt(most);
}

bool is_blended(const Scene& scene, int instance) {
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  return scene.materials[size_t(mesh.material)].alpha_mode == AlphaMode::blend;
}

static dvec3 ahead_of(const View& view) { return -glm::transpose(glm::dmat3(view.view_from_world))[2]; }

static void measure_triangles(const Mesh& mesh, const glm::dmat3& world_from_object, InstanceBox& box) {
  const double stretch = max_stretch(world_from_object);
  box.longest_m = std::min(box.farthest_m - box.nearest_m, stretch * double(mesh.longest_edge));
  box.sliver_m = stretch * double(mesh.longest_sliver);
  const FlatAxes flat = flat_axes_of(world_from_object, mesh.bounds);
  box.flat_axis = flat.world;
  if (flat.world < 0) return;
  const double area = glm::length(
      glm::cross(world_from_object[(flat.object + 1) % 3], world_from_object[(flat.object + 2) % 3]));
  box.thinness *= stretch * stretch / area;
}

InstanceBox box_of(const Scene& scene, int instance, const View& view) {
  const glm::dmat4& world_from_object = scene.instances[size_t(instance)].world_from_object;
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  const Aabb& bounds = mesh.bounds;
  InstanceBox box;
  box.nearest_m = HUGE_VAL;
  box.farthest_m = -HUGE_VAL;
  box.instance = instance;
  box.blended = is_blended(scene, instance);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                            i & 4 ? bounds.max.z : bounds.min.z, 1);
    const dvec3 at(world_from_object * corner);
    box.min = glm::min(box.min, at);
    box.max = glm::max(box.max, at);
    const double away_m = glm::dot(ahead_of(view), at - view.eye);
    box.nearest_m = std::min(box.nearest_m, away_m);
    box.farthest_m = std::max(box.farthest_m, away_m);
  }
  measure_triangles(mesh, glm::dmat3(world_from_object), box);
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

// Sine of the least angle at which a pixel's ray meets the plane of a flat box, up to the distance z along
// the view. Rays through centres pass up to across_ beside the triangle.
double PixelErrors::sine_at(const InstanceBox& box, double z) const {
  const int axis = box.flat_axis;
  if (orthographic_) return std::abs(ahead_[axis]);
  return std::max(std::abs(eye_[axis] - box.min[axis]) / (z * widest_) - across_, 0.0);
}

// Distance between P and Q along the ray. Corners, floats in clip space, err by less than a quarter of
// rounding_m.
double PixelErrors::along_m(const InstanceBox& box, double z, double across_m, double rounding_m) const {
  const double longest_m = widest_ * box.longest_m;
  if (box.flat_axis < 0) return longest_m;
  const double in_plane_m = (across_m + box.thinness * rounding_m) / sine_at(box, z);
  return std::min(longest_m, std::max(in_plane_m, widest_ * box.sliver_m));
}

double PixelErrors::displaced_m(const GrownLightBounds& reach, const InstanceBox& box) const {
  const double light_m = glm::dot(ahead_, reach.light.position - eye_),
               nearest_m = std::max(box.nearest_m, near_m_),
               z = std::max(nearest_m,
                            std::min(light_m + reach.light.radius_m + reach.slack_m, box.farthest_m));
  const double across_m = (orthographic_ ? 1 : z) * across_;
  return fixed_m_ + across_m + along_m(box, z, across_m, reach.slack_m - reach.source_m) +
         z * z / nearest_m * along_;
}

}  // namespace lightgrid
