#include "plan/frame_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/coarse_shadows.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

// After lights.
void plan_effects(const Scene& scene, const TechniqueNeeds& needs, FramePlan& plan) {
  for (const Effect* effect : needs.effects) {
    const std::optional<EffectNeed> need = effect->decide(scene, plan);
    if (!need) continue;
    if (need->needed) plan.effects.push_back(effect);
    const char* of = need->needed && has_masks(*effect) ? needs.masks.of : "";
    plan.decisions.push_back({words_of(*effect), need->needed, need->why + of});
  }
}

// After surfaces, lights and effects.
void plan_base_lighting(const Scene& scene, FramePlan& plan) {
  const int first = first_with_base_lighting(scene, plan.surfaces);
  const auto effect = std::ranges::find_if(plan.effects, [](const Effect* e) { return e->base.has_value(); });
  const bool adds = effect != plan.effects.end();
  plan.surfaces.base_lighting = plan.lights.any_directional || adds || first >= 0;
  plan.decisions.push_back(
      {"base lighting", plan.surfaces.base_lighting,
       plan.lights.any_directional ? light_witness(scene, plan.lights.directional[0])
       : adds                      ? words_of(**effect)
       : first >= 0
           ? instance_witness(scene, first)
           : "no opaque surface is emissive, unlit or has an occlusion map; no light is directional"});
}

void turn_everything_on(const Scene& scene, const View& view, const TechniqueNeeds& needs, FramePlan& plan) {
  plan_every_feature(plan.settings, plan.surfaces);
  plan_every_light(plan.lights);
  plan_every_list(needs.lists, plan.lists);
  plan.effects.clear();
  for (const Effect* effect : needs.effects) {
    const std::optional<EffectNeed> need = effect->decide(scene, plan);
    if (!need || !(need->needed || need->idles)) continue;
    plan.effects.push_back(effect);
    if (has_masks(*effect))
      plan_every_mask(scene, needs.masks, plan.settings, plan.opengl, plan.lists, plan.masks);
  }
  plan_every_shadow(scene, view, needs.shadows, plan.settings, plan.lights, plan.shadows);
}

}  // namespace

bool draws_with_opengl(const TechniqueNeeds& needs, const Settings& settings) {
  return needs.surfaces.opengl &&
         !(needs.surfaces.chosen_raster && settings[setting::raster] == RasterApi::opencl);
}

FramePlan plan_frame(const Scene& scene, const View& view, const Settings& settings, TechniqueNeeds needs,
                     PlannedInstances instances, PlannedLights lights) {
  FramePlan plan{.settings = settings};
  Settings& s = plan.settings;
  if (needs.adapt) needs.adapt(needs, s);
  plan.opengl = draws_with_opengl(needs, settings);
  plan.reversed_triangles = needs.surfaces.reversed_triangles;
  if (needs.lists.no_masks) s.set(setting::grid_lists, GridLists::lists);
  if (!needs.lists.capped) s.reset(setting::list_cap).reset(setting::view_cap);
  check_lists(needs.lists, s);
  Decisions& decisions = plan.decisions;
  decisions.reserve(feature_names.size() + 16);
  plan.surfaces = plan_surfaces(scene, view, s, instances, decisions);
  plan.lights = plan_lights(scene, view, s, lights, decisions);
  plan.lights.in_block = needs.lists.light_block;
  plan_effects(scene, needs, plan);
  plan_base_lighting(scene, plan);
  plan.lists = plan_lists(scene, view, needs.lists, s, plan.surfaces, plan.lights, decisions);
  plan.masks = plan_masks(scene, plan.effects, needs.masks, s, plan.opengl, plan.lists);
  plan.stencil = needs.surfaces.stencil || plan.masks.stencil_bits > 0;
  plan.shadows =
      plan_shadows(scene, view, needs.shadows, s, instances, plan.surfaces, plan.lights, decisions);
  plan_samples(scene, needs.samples, plan.opengl, needs.surfaces.stored, plan.surfaces, plan.shadows, s,
               decisions);
  if (s[setting::everything_on]) turn_everything_on(scene, view, needs, plan);
  return plan;
}

std::string describe(const FramePlan& plan, const Scene& scene) {
  const ShownCounts all = shown_counts(scene);
  std::string text =
      fmt::format("{} of {} instances in view ({} opaque, {} blended), {} of {} lights\n",
                  plan.surfaces.opaque.size() + plan.surfaces.blended.size(), all.instances,
                  plan.surfaces.opaque.size(), plan.surfaces.blended.size(), plan.lights.in_view, all.lights);
  for (const Decision& d : plan.decisions)
    text += fmt::format("  {} {}: {}\n", d.needed ? "yes" : " no", d.effect, d.why);
  text += describe_shadows(plan.shadows.casting, scene, plan.shadows.found_by);
  const std::string coarse = describe(coarse_shadows(scene, ranges_of(plan.settings)), scene);
  return coarse.empty() ? text : fmt::format("{}  {}\n", text, coarse);
}

}  // namespace lightgrid
