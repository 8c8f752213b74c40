#include "plan/light_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/settings/grid.h"
#include "plan/settings/model.h"
#include "plan/visibility.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

// Leaves out all lights but the nearest of those whose range the view sees, `seen` by index into `local`.
void cap_view(const std::vector<ViewLight>& lights, std::vector<size_t> seen, const Settings& settings,
              LightPlan& plan, Decisions& decisions) {
  const size_t cap = size_t(settings[setting::view_cap]);
  if (cap == 0) return;
  if (seen.size() > cap) {
    std::ranges::stable_sort(seen, {}, [&](size_t i) {
      const glm::dvec3& p = lights[size_t(plan.local[i])].position;
      return glm::dot(p, p);
    });
    plan.left_out.assign(plan.local.size(), 1);
    for (size_t i = 0; i < cap; ++i) plan.left_out[seen[i]] = 0;
  }
  decisions.push_back({"view cap", seen.size() > cap,
                       fmt::format("view-cap={}, {} point and spot lights in view", cap, seen.size())});
}

}  // namespace

std::string light_witness(const Scene& scene, int light) {
  return fmt::format("light {} \"{}\"", light, scene.lights[light].name);
}

bool counts_as_seen(PlannedLights planned, const ViewLight& light, bool in_view) {
  if (planned == PlannedLights::points) return !has_cone(light);
  if (planned == PlannedLights::spots) return has_cone(light);
  return planned == PlannedLights::in_view ? in_view : planned == PlannedLights::every;
}

LightPlan plan_lights(const Scene& scene, const View& view, const Settings& settings, PlannedLights planned,
                      Decisions& decisions) {
  LightPlan plan{.planned = planned};
  const Frustum frustum = frustum_of(view);
  const std::vector<ViewLight> lights = lights_in_view(scene, view, ranges_of(settings));
  std::vector<size_t> seen_local;
  int first_spot = -1, first_virtual = -1;
  for (int i = 0; i < int(lights.size()); ++i) {
    const bool directional = is_directional(lights[i]);
    (directional ? plan.directional : plan.local).push_back(i);
    const bool in_view = may_see_sphere(frustum, lights[i].position, lights[i].radius_m);
    const bool seen = directional || counts_as_seen(planned, lights[i], in_view);
    plan.in_view += seen && !is_hidden(scene.lights[size_t(i)]);
    if (seen && !directional) seen_local.push_back(plan.local.size() - 1);
    // A spot out of view still needs its cone: the cone makes its contribution zero in view.
    if (has_cone(lights[i]) && first_spot < 0) first_spot = i;
    if (!scene.lights[size_t(i)].is_virtual) continue;
    if (plan.virtual_count++ == 0) first_virtual = i;
  }
  plan.any_local = !plan.local.empty();
  plan.spots = first_spot >= 0;
  plan.any_virtual = plan.virtual_count > 0;
  plan.any_directional = !plan.directional.empty();
  plan.index_bits = plan.local.size() <= 65536 ? 16 : 32;
  const auto& local = plan.local;
  decisions.push_back({"point and spot lights", plan.any_local,
                       plan.any_local ? light_witness(scene, local[0]) : "no light has a place"});
  decisions.push_back(
      {"spot cones", plan.spots, plan.spots ? light_witness(scene, first_spot) : "no light is a spot"});
  decisions.push_back({"virtual lights", plan.any_virtual,
                       plan.any_virtual
                           ? fmt::format("{} of {} lights, the first of them {}", plan.virtual_count,
                                         lights.size(), light_witness(scene, first_virtual))
                           : "no light is virtual"});
  decisions.push_back(
      {"directional lights", plan.any_directional,
       plan.any_directional ? light_witness(scene, plan.directional[0]) : "no light is directional"});
  decisions.push_back(
      {"32-bit light indices", plan.index_bits == 32, fmt::format("{} point and spot lights", local.size())});
  cap_view(lights, std::move(seen_local), settings, plan, decisions);
  return plan;
}

void plan_every_light(LightPlan& plan) {
  plan.any_local = plan.spots = plan.any_virtual = plan.any_directional = true;
  plan.index_bits = 32;
}

}  // namespace lightgrid
