#include "plan/light_shadows.h"

#include <algorithm>
#include <cmath>

#include "plan/instance_boxes.h"
#include "plan/visibility.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

using glm::dvec3;

bool casts(const Scene& scene, int instance, BlendedCasters by_blended) {
  const Mesh& mesh = scene.meshes[size_t(scene.instances[size_t(instance)].mesh)];
  return scene.instances[size_t(instance)].casts_shadow && !mesh.indices.empty() && !mesh.bounds.empty() &&
         (by_blended != BlendedCasters::none || !is_blended(scene, instance));
}

struct Boxes {
  std::vector<InstanceBox> casters, receivers;
  double diameter_m = 0;  // diameter of all of them and the eye
};

Boxes boxes_of(const Scene& scene, const View& view, const std::vector<int>& opaque,
               const std::vector<int>& blended, BlendedCasters by_blended) {
  Boxes boxes;
  for (int i = 0; i < int(scene.instances.size()); ++i)
    if (casts(scene, i, by_blended)) boxes.casters.push_back(box_of(scene, i, view));
  for (const auto* instances : {&opaque, &blended})
    for (const int i : *instances) {
      InstanceBox& box = boxes.receivers.emplace_back(box_of(scene, i, view));
      box.blended = box.blended && by_blended != BlendedCasters::opaque;  // else light does not come through
    }
  dvec3 min = view.eye, max = view.eye;
  for (const auto* some : {&boxes.casters, &boxes.receivers})
    for (const InstanceBox& box : *some) {
      min = glm::min(min, box.min);
      max = glm::max(max, box.max);
    }
  boxes.diameter_m = glm::length(max - min);
  return boxes;
}

bool overlap(const dvec3& min, const dvec3& max, const InstanceBox& box) {
  return glm::all(glm::lessThanEqual(box.min, max)) && glm::all(glm::lessThanEqual(min, box.max));
}

// True if nothing hides any point of a flat receiver: light and eye are on one side of it, and each caster is
// below its plane, or out of the box around it and the light.
// A ray to the plane ends gap_m before it, hence at least gap_m times the sine of its slope above it. If that
// is more than rounding moves casters and the ray's end, then the receiver's own triangles do not meet the
// ray, nor does what lies in the plane or below it. Floats relative to the scene's middle err by less than
// 2^-21.
bool nothing_hides(const InstanceBox& receiver, const GrownLightBounds& reach, const dvec3& eye,
                   double diameter_m, const std::vector<const InstanceBox*>& casters) {
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
  return std::ranges::all_of(casters, [&](const InstanceBox* caster) {
    const double highest = up > 0 ? caster->max[axis] - plane : plane - caster->min[axis];
    return highest <= across_m || !overlap(min, max, *caster);
  });
}

// The first caster, or receiver, whose triangles hide those behind them from their own points.
template <typename InReach>
const InstanceBox* first_caster(const Boxes& boxes, const InReach& in_reach) {
  const auto caster = std::ranges::find_if(boxes.casters, in_reach);
  if (caster != boxes.casters.end()) return &*caster;
  const auto receiver = std::ranges::find_if(
      boxes.receivers, [&](const InstanceBox& box) { return !box.blended && in_reach(box); });
  return receiver == boxes.receivers.end() ? nullptr : &*receiver;
}

LightShadow plan_directional_light(int number, const Boxes& boxes) {
  const InstanceBox* caster = first_caster(boxes, [](const InstanceBox&) { return true; });
  if (!caster) return {number, ShadowNeed::no_caster};
  if (boxes.receivers.empty()) return {number, ShadowNeed::no_receiver};
  return {number, ShadowNeed::rays, caster->instance};
}

LightShadow plan_light(const LightBounds& light, int number, const View& view, const Boxes& boxes,
                       const PixelErrors& errors, double source_m) {
  // Positions are floats relative to the eye or to the scene's middle. What is computed with them together
  // errs by less than 2^-19 of the distances.
  const double rounding_m = (boxes.diameter_m + glm::length(light.position - view.eye)) * 0x1p-19;
  const GrownLightBounds reach{light, rounding_m + source_m, source_m};
  const dvec3 position_view = glm::dmat3(view.view_from_world) * (light.position - view.eye);
  if (!may_see_sphere(frustum_of(view), position_view, light.radius_m + reach.slack_m))
    return {number, ShadowNeed::no_receiver};
  // Points that pixels show lie beside their triangles, and so do the segments to them.
  double beside_m = 0;
  std::vector<const InstanceBox*> receivers, casters;
  for (const InstanceBox& box : boxes.receivers) {
    const double of_box_m = errors.displaced_m(reach, box);
    if (!may_reach(reach.grown(of_box_m), box)) continue;
    receivers.push_back(&box);
    beside_m = std::max(beside_m, of_box_m);
  }
  const GrownLightBounds beside = reach.grown(beside_m);
  const auto in_reach = [&](const InstanceBox& box) { return may_reach(beside, box); };
  const InstanceBox* caster = first_caster(boxes, in_reach);
  if (!caster) return {number, ShadowNeed::no_caster};
  if (receivers.empty()) return {number, ShadowNeed::no_receiver};
  // Points of receivers that are not flat may be hidden by the receiver itself. Of many, all count as such.
  constexpr size_t max_receivers = 8;
  if (receivers.size() > max_receivers ||
      std::ranges::any_of(receivers, [](const InstanceBox* box) { return box->flat_axis < 0; }))
    return {number, ShadowNeed::rays, caster->instance};
  for (const InstanceBox& box : boxes.casters)
    if (in_reach(box)) casters.push_back(&box);
  const bool behind = !view.orthographic && std::ranges::all_of(receivers, [&](const InstanceBox* receiver) {
    return nothing_hides(*receiver, beside, view.eye, boxes.diameter_m, casters);
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
  const PixelErrors errors(view);
  for (int i = 0; i < int(scene.lights.size()); ++i) {
    const Light& light = scene.lights[size_t(i)];
    if (!light.casts_shadow || is_hidden(light)) continue;
    plans.push_back(is_directional(light) ? plan_directional_light(i, boxes)
                                          : plan_light(bounds_of(light, range_of(light, size_t(i), ranges)),
                                                       i, view, boxes, errors, source_of(light, source_m)));
  }
  return plans;
}

}  // namespace lightgrid
