#include "plan/shadow_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/dim_lights.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

// Shadows of all lights that cast are found: for any view.
void shadow_all(const Scene& scene, const LightPlan& lights, ShadowPlan& plan) {
  const auto casts = [&](int i) { return scene.lights[size_t(i)].casts_shadow; };
  plan.shadowed.clear();
  for (const auto* kind : {&lights.local, &lights.directional})
    for (const int i : *kind) plan.shadowed.push_back(casts(i));
  plan.needed = plan.light_reaches = std::ranges::count(plan.shadowed, 1) > 0;
  plan.directional = std::ranges::any_of(lights.directional, casts);
  if (!plan.needed) plan.shadowed.clear();
}

// By index into ShadowPlan::shadowed.
size_t place_of_light(const LightPlan& lights, int light) {
  const auto at = std::ranges::lower_bound(lights.local, light);
  if (at != lights.local.end() && *at == light) return size_t(at - lights.local.begin());
  const auto directional = std::ranges::lower_bound(lights.directional, light);
  return lights.local.size() + size_t(directional - lights.directional.begin());
}

// Hands the shadows of point and spot lights over to the technique; if it takes fewer, those of the lights of
// most influence.
void take_own_shadows(const Scene& scene, const View& view, const ShadowNeeds& needs,
                      const Settings& settings, const LightPlan& lights, ShadowPlan& plan) {
  const auto casts = [&](int i) { return scene.lights[size_t(i)].casts_shadow; };
  plan.own = needs.max_own > 0 && std::ranges::any_of(lights.local, casts);
  plan.light_reaches = plan.directional;
  if (!plan.needed) return;
  const auto end_of_local = plan.shadowed.begin() + std::ptrdiff_t(lights.local.size());
  plan.own_shadowed.assign(plan.shadowed.begin(), end_of_local);
  std::fill(plan.shadowed.begin(), end_of_local, uint8_t(0));
  std::vector<size_t> shadowed;
  for (size_t i = 0; i < lights.local.size(); ++i)
    if (plan.own_shadowed[i]) shadowed.push_back(i);
  if (shadowed.size() > needs.max_own) {
    const std::vector<ViewLight> in_view = lights_in_view(scene, view, ranges_of(settings), lights.local);
    std::ranges::stable_sort(shadowed, std::greater(), [&](size_t i) { return influence_of(in_view[i]); });
    for (size_t i = needs.max_own; i < shadowed.size(); ++i) {
      plan.own_shadowed[shadowed[i]] = 0;
      const auto left_out = std::ranges::find(plan.casting, lights.local[shadowed[i]], &LightShadow::light);
      left_out->need = ShadowNeed::left_out;
    }
  }
  if (std::ranges::count(plan.own_shadowed, 1) == 0) plan.own_shadowed.clear();
  plan.needed = std::ranges::count(plan.shadowed, 1) > 0;
  if (!plan.needed) plan.shadowed.clear();
}

// Shadows for which no rays are traced.
void leave_out(const LightPlan& lights, ShadowPlan& plan) {
  plan.needed = false;
  for (const LightShadow& light : plan.casting) {
    const bool rays = light.need == ShadowNeed::rays;
    plan.shadowed[place_of_light(lights, light.light)] = rays;
    plan.needed = plan.needed || rays;
  }
  if (!plan.needed) plan.shadowed.clear();
}

}  // namespace

ShadowPlan plan_shadows(const Scene& scene, const View& view, const ShadowNeeds& needs,
                        const Settings& settings, PlannedInstances instances, const SurfacePlan& surfaces,
                        const LightPlan& lights, Decisions& decisions) {
  ShadowPlan plan;
  if (settings[setting::shadows] == ShadowMethod::none) {
    decisions.push_back({"shadows", false, "shadows=none"});
    return plan;
  }
  if (needs.asked_for) shadow_all(scene, lights, plan);
  plan.casting = plan_light_shadows(scene, view, ranges_of(settings), surfaces.opaque, surfaces.blended,
                                    soft_shadows(settings) ? settings[setting::shadow_source_m] : 0,
                                    blended_casters(settings));
  if (!settings[setting::everything_on])
    plan.dim_steps =
        leave_out_dim_lights(scene, view, settings, surfaces.opaque, surfaces.blended, plan.casting);
  if (instances == PlannedInstances::in_view && plan.needed) leave_out(lights, plan);
  plan.found_by = settings[setting::shadows] == ShadowMethod::map ? "maps" : "rays";
  if (needs.own) take_own_shadows(scene, view, needs, settings, lights, plan);
  // Shadows of directional lights are found by the pass.
  if (!plan.own_shadowed.empty()) plan.found_by = needs.found_by;
  const auto rays = std::ranges::find(plan.casting, ShadowNeed::rays, &LightShadow::need);
  decisions.push_back({"shadows", plan.needed || !plan.own_shadowed.empty(),
                       plan.casting.empty() ? "no light casts one"
                       : !needs.asked_for   ? needs.why_none
                       : rays != plan.casting.end()
                           ? fmt::format("{} reaches {}", light_witness(scene, rays->light),
                                         instance_witness(scene, rays->caster))
                           : fmt::format("{}: {}", light_witness(scene, plan.casting[0].light),
                                         reason_of(plan.casting[0].need))});
  plan.bytes = soft_shadows(settings) || picks_shadows(settings) ||
               (settings[setting::shadows] == ShadowMethod::map && settings[setting::shadow_taps] > 1) ||
               (plan.light_reaches && has_veils(scene, blended_casters(settings)));
  return plan;
}

void plan_every_shadow(const Scene& scene, const View& view, const ShadowNeeds& needs,
                       const Settings& settings, const LightPlan& lights, ShadowPlan& plan) {
  if (!needs.asked_for || settings[setting::shadows] == ShadowMethod::none) return;
  shadow_all(scene, lights, plan);
  if (needs.own) take_own_shadows(scene, view, needs, settings, lights, plan);
  plan.light_reaches = true;
}

}  // namespace lightgrid
