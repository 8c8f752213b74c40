#include "plan/shadow_plan.h"

#include <algorithm>
#include <cmath>

#include "plan/visibility.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// An instance in world space.
struct Box {
  dvec3 corners[8];
  dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
  int instance = 0;
  bool blended = false;  // lets light through from behind
  int flat_axis =
      -1;  // of the world: all triangles lie in one plane across it, to the last bit. -1: they may not
};

// The world's axis along which an instance has no extent: its mesh's box has none along an object's axis,
// which alone moves a point along the world's. Rounding then moves all points alike, so that even slivers
// stay in the plane. -1: none.
int flat_axis_of(const glm::dmat4& world_from_object, const Aabb& bounds) {
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

Box box_of(const Scene& scene, int instance, BlendedCasters by_blended) {
  const glm::dmat4& world_from_object = scene.instances[size_t(instance)].world_from_object;
  const Aabb& bounds = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)].bounds;
  Box box;
  box.instance = instance;
  box.blended = by_blended != BlendedCasters::opaque && is_blended(scene, instance);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 corner(i & 1 ? bounds.max.x : bounds.min.x, i & 2 ? bounds.max.y : bounds.min.y,
                            i & 4 ? bounds.max.z : bounds.min.z, 1);
    box.corners[i] = dvec3(world_from_object * corner);
    box.min = glm::min(box.min, box.corners[i]), box.max = glm::max(box.max, box.corners[i]);
  }
  box.flat_axis = flat_axis_of(world_from_object, bounds);
  return box;
}

bool casts(const Scene& scene, int instance, BlendedCasters by_blended) {
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  return scene.instances[size_t(instance)].casts_shadow && !mesh.indices.empty() && !mesh.bounds.empty() &&
         (by_blended != BlendedCasters::none || !is_blended(scene, instance));
}

double distance_to(const Box& box, const dvec3& point) {
  return glm::length(point - glm::clamp(point, box.min, box.max));
}

double farthest_from(const Box& box, const dvec3& point) {
  return glm::length(glm::max(glm::abs(box.min - point), glm::abs(box.max - point)));
}

// A light's bounds, grown by what rounding may move positions, and by the sphere's radius: segments to a
// sphere's points are no further than that from those to its centre.
struct Reach {
  LightBounds light;
  double slack_m = 0, source_m = 0;
};

bool may_reach(const Reach& reach, const Box& box) {
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

struct Boxes {
  std::vector<Box> casters, receivers;
  double diameter_m = 0;  // of all of them and the eye
};

Boxes boxes_of(const Scene& scene, const View& view, const std::vector<int>& opaque,
               const std::vector<int>& blended, BlendedCasters by_blended) {
  Boxes boxes;
  for (int i = 0; i < int(scene.instances.size()); ++i)
    if (casts(scene, i, by_blended)) boxes.casters.push_back(box_of(scene, i, by_blended));
  for (const auto* instances : {&opaque, &blended})
    for (const int i : *instances) boxes.receivers.push_back(box_of(scene, i, by_blended));
  dvec3 min = view.eye, max = view.eye;
  for (const auto* some : {&boxes.casters, &boxes.receivers})
    for (const Box& box : *some) min = glm::min(min, box.min), max = glm::max(max, box.max);
  boxes.diameter_m = glm::length(max - min);
  return boxes;
}

bool overlap(const dvec3& min, const dvec3& max, const Box& box) {
  return glm::all(glm::lessThanEqual(box.min, max)) && glm::all(glm::lessThanEqual(min, box.max));
}

// Whether nothing hides any point of a flat receiver: light and eye are on one side of it, and each caster is
// below its plane, or out of the box around it and the light.
// A ray to the plane ends gap_m before it, hence at least gap_m times the sine of its slope above it. If that
// is more than rounding moves casters and the ray's end, then the receiver's own triangles do not meet the
// ray, nor does what lies in the plane or below it. Floats relative to the scene's middle err by less than
// 2^-21.
bool nothing_hides(const Box& receiver, const Reach& reach, const dvec3& eye, double diameter_m,
                   const std::vector<const Box*>& casters) {
  constexpr double gap_m = 0.001;
  const int axis = receiver.flat_axis;
  const dvec3& light = reach.light.position;
  const double across_m = diameter_m * 0x1p-21, plane = receiver.min[axis];
  const double up = light[axis] > plane ? 1 : -1, height_m = up * (light[axis] - plane) - reach.source_m;
  const double farthest_m = std::min(reach.light.radius_m, farthest_from(receiver, light)) + reach.slack_m;
  if (!(height_m * gap_m > 4 * across_m * farthest_m)) return false;
  if (!(up * (eye[axis] - plane) > reach.slack_m)) return false;
  const dvec3 min = glm::min(receiver.min, light) - reach.slack_m;
  const dvec3 max = glm::max(receiver.max, light) + reach.slack_m;
  return std::ranges::all_of(casters, [&](const Box* caster) {
    const double highest = up > 0 ? caster->max[axis] - plane : plane - caster->min[axis];
    return highest <= across_m || !overlap(min, max, *caster);
  });
}

// Of all that may cast, or of receivers, whose triangles hide those behind them from their own points.
template <typename InReach>
const Box* first_caster(const Boxes& boxes, const InReach& in_reach) {
  const auto caster = std::ranges::find_if(boxes.casters, in_reach);
  if (caster != boxes.casters.end()) return &*caster;
  const auto receiver = std::ranges::find_if(
      boxes.receivers, [&](const Box& box) { return !box.blended && in_reach(box); });
  return receiver == boxes.receivers.end() ? nullptr : &*receiver;
}

LightShadow plan_directional_light(int number, const Boxes& boxes) {
  const Box* caster = first_caster(boxes, [](const Box&) { return true; });
  if (!caster) return {number, ShadowNeed::no_caster};
  if (boxes.receivers.empty()) return {number, ShadowNeed::no_receiver};
  return {number, ShadowNeed::rays, caster->instance};
}

LightShadow plan_light(const LightBounds& light, int number, const View& view, const Boxes& boxes,
                       double source_m) {
  // Positions are floats relative to the eye or to the scene's middle. What is computed with them together
  // errs by less than 2^-19 of the distances.
  const double rounding_m = (boxes.diameter_m + glm::length(light.position - view.eye)) * 0x1p-19;
  const Reach reach{light, rounding_m + source_m, source_m};
  const dvec3 position_view = glm::dmat3(view.view_from_world) * (light.position - view.eye);
  if (!may_see_sphere(frustum_of(view), position_view, light.radius_m + reach.slack_m))
    return {number, ShadowNeed::no_receiver};
  const auto in_reach = [&](const Box& box) { return may_reach(reach, box); };
  const Box* caster = first_caster(boxes, in_reach);
  if (!caster) return {number, ShadowNeed::no_caster};
  // Points of receivers that are not flat may be hidden by the receiver itself. Of many, all count as such.
  constexpr size_t most_receivers = 8;
  std::vector<const Box*> receivers, casters;
  for (const Box& box : boxes.receivers) {
    if (!in_reach(box)) continue;
    if (box.flat_axis < 0 || receivers.size() == most_receivers)
      return {number, ShadowNeed::rays, caster->instance};
    receivers.push_back(&box);
  }
  if (receivers.empty()) return {number, ShadowNeed::no_receiver};
  for (const Box& box : boxes.casters)
    if (in_reach(box)) casters.push_back(&box);
  const bool behind = !view.orthographic && std::ranges::all_of(receivers, [&](const Box* receiver) {
    return nothing_hides(*receiver, reach, view.eye, boxes.diameter_m, casters);
  });
  if (behind) return {number, ShadowNeed::casters_behind};
  return {number, ShadowNeed::rays, caster->instance};
}

}  // namespace

bool has_veils(const Scene& scene, BlendedCasters by_blended) {
  if (by_blended != BlendedCasters::alpha) return false;
  for (int i = 0; i < int(scene.instances.size()); ++i)
    if (is_blended(scene, i) && casts(scene, i, by_blended)) return true;
  return false;
}

std::vector<LightShadow> plan_light_shadows(const Scene& scene, const View& view, const LightRanges& ranges,
                                            const std::vector<int>& opaque, const std::vector<int>& blended,
                                            double source_m, BlendedCasters by_blended) {
  std::vector<LightShadow> plans;
  if (std::ranges::none_of(scene.lights, &Light::casts_shadow)) return plans;
  const Boxes boxes = boxes_of(scene, view, opaque, blended, by_blended);
  for (int i = 0; i < int(scene.lights.size()); ++i) {
    const Light& light = scene.lights[size_t(i)];
    if (!light.casts_shadow) continue;
    plans.push_back(is_directional(light)
                        ? plan_directional_light(i, boxes)
                        : plan_light(bounds_of(light, range_of(light, size_t(i), ranges)), i, view, boxes,
                                     source_m));
  }
  return plans;
}

}  // namespace lightgrid
