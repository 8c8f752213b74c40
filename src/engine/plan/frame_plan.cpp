#include "plan/frame_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/coarse_shadows.h"
#include "plan/dim_lights.h"
#include "plan/light_plan.h"
#include "plan/settings/grid.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/samples.h"
#include "plan/settings/shadows.h"
#include "plan/settings/surfaces.h"
#include "plan/visibility.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

struct FeatureName {
  uint32_t bit;
  const char* define;
  const char* effect;
};

constexpr FeatureName feature_names[] = {
    {feature_textured, "TEXTURED", "textures"},
    {feature_uv1, "UV1", "second UV set"},
    {feature_uv_transform, "UV_TRANSFORM", "texture transforms"},
    {feature_vertex_color, "VERTEX_COLOR", "vertex colours"},
    {feature_base_color_map, "BASE_COLOR_MAP", "base colour maps"},
    {feature_metallic_roughness_map, "METALLIC_ROUGHNESS_MAP", "metallic-roughness maps"},
    {feature_normal_map, "NORMAL_MAP", "normal maps"},
    {feature_occlusion_map, "OCCLUSION_MAP", "occlusion maps"},
    {feature_emissive_map, "EMISSIVE_MAP", "emissive maps"},
    {feature_mask, "MASK", "alpha masks"},
    {feature_unlit, "UNLIT", "unlit materials"},
    {feature_clearcoat, "CLEARCOAT", "clearcoat"},
    {feature_clearcoat_map, "CLEARCOAT_MAP", "clearcoat maps"},
    {feature_clearcoat_roughness_map, "CLEARCOAT_ROUGHNESS_MAP", "clearcoat roughness maps"},
    {feature_clearcoat_normal_map, "CLEARCOAT_NORMAL_MAP", "clearcoat normal maps"},
    {feature_skin, "SKIN", "skin"},
    {feature_minnaert, "MINNAERT", "Minnaert"},
    {feature_specular, "SPECULAR", "specular reflectance"},
    {feature_specular_map, "SPECULAR_MAP", "specular maps"},
    {feature_specular_color_map, "SPECULAR_COLOR_MAP", "specular colour maps"},
};

std::string instance_witness(const Scene& scene, int instance) {
  const Instance& i = scene.instances[instance];
  const int material = scene.meshes[i.mesh].material;
  return fmt::format("material {} \"{}\" on node {} \"{}\"", material, scene.materials[material].name,
                     instance, i.name);
}

bool shows_base_lighting(const Scene& scene, int instance) {
  const Material& material = scene.materials[scene.meshes[scene.instances[instance].mesh].material];
  return material.unlit || material.emissive != glm::vec3(0) || material.occlusion_map.texture >= 0;
}

bool is_planned(const Scene& scene, int instance, PlannedInstances instances) {
  const Mesh& mesh = scene.meshes[scene.instances[instance].mesh];
  const AlphaMode alpha = scene.materials[mesh.material].alpha_mode;
  const bool coats = instances == PlannedInstances::every || instances == PlannedInstances::plain_or_coated;
  if (!coats && (material_features(scene, mesh) & feature_clearcoat)) return false;
  if (instances == PlannedInstances::every || instances == PlannedInstances::uncoated) return true;
  const bool masks = instances != PlannedInstances::plain;
  return (alpha == AlphaMode::opaque || (masks && alpha == AlphaMode::mask)) &&
         !shows_base_lighting(scene, instance);
}

// After lights.
void plan_effects(const Scene& scene, Effects effects, FramePlan& plan) {
  for (const Effect* effect : effects) {
    const std::optional<EffectNeed> need = effect->decide(scene, plan);
    if (!need) continue;
    if (need->needed) plan.effects.push_back(effect);
    plan.decisions.push_back({words_of(*effect), need->needed, need->why});
  }
}

// After surfaces, lights and effects.
void plan_base_lighting(const Scene& scene, FramePlan& plan) {
  const auto first = std::find_if(plan.opaque.begin(), plan.opaque.end(),
                                  [&](int i) { return shows_base_lighting(scene, i); });
  const auto effect = std::ranges::find_if(plan.effects, [](const Effect* e) { return e->base.has_value(); });
  const bool adds = effect != plan.effects.end();
  plan.base_lighting = plan.directional || adds || first != plan.opaque.end();
  plan.decisions.push_back(
      {"base lighting", plan.base_lighting,
       plan.directional ? light_witness(scene, plan.directional_lights[0])
       : adds           ? words_of(**effect)
       : plan.base_lighting
           ? instance_witness(scene, *first)
           : "no opaque surface is emissive, unlit or has an occlusion map; no light is directional"});
}

void plan_models(const Scene& scene, FramePlan& plan) {
  for (const Instance& instance : scene.instances) {
    const Material& m = scene.materials[scene.meshes[instance.mesh].material];
    if (m.unlit || m.alpha_mode == AlphaMode::blend) continue;
    plan.skin = plan.skin || m.model.skin();
    plan.minnaert = plan.minnaert || m.model.minnaert();
    plan.specular = plan.specular ||
                    (has_specular(m) && features_read(feature_specular, plan.settings[setting::brdf]) != 0);
  }
}

// Collects what the instances in view need, each need with its first witness. Returns the distance of the
// farthest of them.
double plan_surfaces(const Scene& scene, const View& view, PlannedInstances instances, FramePlan& plan) {
  const Frustum frustum = frustum_of(view);
  const auto planned = [&](int i, const glm::dmat4& to_view) {
    return instances == PlannedInstances::in_view
               ? !is_hidden(scene.instances[i]) &&
                     may_see_box(frustum, to_view, scene.meshes[scene.instances[i].mesh].bounds)
               : is_planned(scene, i, instances);
  };
  plan.features_of_instance.assign(scene.instances.size(), 0);
  int first_with[std::size(feature_names)];
  std::fill(std::begin(first_with), std::end(first_with), -1);
  std::vector<std::pair<double, int>> blended;
  double farthest_m = view.near_m;
  for (int i = 0; i < int(scene.instances.size()); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const glm::dmat4 to_view = view_from_object(view, scene.instances[i].world_from_object);
    if (mesh.indices.empty() || !planned(i, to_view)) continue;
    const uint32_t features = features_read(material_features(scene, mesh), plan.settings[setting::brdf]);
    farthest_m = std::max(farthest_m, farthest_of_box(to_view, mesh.bounds));
    plan.features_of_instance[i] = features;
    plan.features |= features;
    for (size_t f = 0; f < std::size(feature_names); ++f) {
      if ((features & feature_names[f].bit) && first_with[f] < 0) first_with[f] = i;
    }
    if (scene.materials[mesh.material].alpha_mode == AlphaMode::blend) {
      const glm::dvec3 center = 0.5 * (glm::dvec3(mesh.bounds.min) + glm::dvec3(mesh.bounds.max));
      blended.emplace_back((to_view * glm::dvec4(center, 1)).z, i);
    } else {
      plan.opaque.push_back(i);
      plan.clearcoat = plan.clearcoat || (features & feature_clearcoat);
    }
  }
  std::stable_sort(blended.begin(), blended.end(), [](auto& a, auto& b) { return a.first < b.first; });
  for (const auto& [z, i] : blended) plan.blended.push_back(i);
  plan.blend = !blended.empty();
  plan.mask = plan.features & feature_mask;
  plan.decisions.push_back(
      {"blend", plan.blend,
       plan.blend ? instance_witness(scene, *std::min_element(plan.blended.begin(), plan.blended.end()))
                  : "no blended material in view"});
  for (size_t f = 0; f < std::size(feature_names); ++f) {
    const bool left_out = features_read(feature_names[f].bit, plan.settings[setting::brdf]) == 0;
    plan.decisions.push_back({feature_names[f].effect, first_with[f] >= 0,
                              first_with[f] >= 0 ? instance_witness(scene, first_with[f])
                              : left_out         ? "brdf=lambert has no lobes"
                                                 : "no material in view has any"});
  }
  return farthest_m;
}

// Shadows of all lights that cast are found: for any view.
void shadow_all(const Scene& scene, FramePlan& plan) {
  const auto casts = [&](int i) { return scene.lights[size_t(i)].casts_shadow; };
  plan.shadowed.clear();
  for (const auto* lights : {&plan.local, &plan.directional_lights})
    for (const int i : *lights) plan.shadowed.push_back(casts(i));
  plan.shadows = plan.light_reaches = std::ranges::count(plan.shadowed, 1) > 0;
  plan.directional_shadows = std::ranges::any_of(plan.directional_lights, casts);
  if (!plan.shadows) plan.shadowed.clear();
}

// By index into FramePlan::shadowed.
size_t place_of_light(const FramePlan& plan, int light) {
  const auto at = std::ranges::lower_bound(plan.local, light);
  if (at != plan.local.end() && *at == light) return size_t(at - plan.local.begin());
  const auto directional = std::ranges::lower_bound(plan.directional_lights, light);
  return plan.local.size() + size_t(directional - plan.directional_lights.begin());
}

// Hands the shadows of point and spot lights over to the technique; if it takes fewer, those of the lights of
// most influence.
void take_own_shadows(const Scene& scene, const View& view, const TechniqueNeeds& needs, FramePlan& plan) {
  const auto casts = [&](int i) { return scene.lights[size_t(i)].casts_shadow; };
  plan.own_shadows = needs.most_own_shadows > 0 && std::ranges::any_of(plan.local, casts);
  plan.light_reaches = plan.directional_shadows;
  if (!plan.shadows) return;
  const auto end_of_local = plan.shadowed.begin() + std::ptrdiff_t(plan.local.size());
  plan.own_shadowed.assign(plan.shadowed.begin(), end_of_local);
  std::fill(plan.shadowed.begin(), end_of_local, uint8_t(0));
  std::vector<size_t> shadowed;
  for (size_t i = 0; i < plan.local.size(); ++i)
    if (plan.own_shadowed[i]) shadowed.push_back(i);
  if (shadowed.size() > needs.most_own_shadows) {
    const std::vector<ViewLight> lights = lights_in_view(scene, view, ranges_of(plan.settings), plan.local);
    std::ranges::stable_sort(shadowed, std::greater(), [&](size_t i) { return influence_of(lights[i]); });
    for (size_t i = needs.most_own_shadows; i < shadowed.size(); ++i) {
      plan.own_shadowed[shadowed[i]] = 0;
      const auto left_out = std::ranges::find(plan.casting, plan.local[shadowed[i]], &LightShadow::light);
      left_out->need = ShadowNeed::left_out;
    }
  }
  if (std::ranges::count(plan.own_shadowed, 1) == 0) plan.own_shadowed.clear();
  plan.shadows = std::ranges::count(plan.shadowed, 1) > 0;
  if (!plan.shadows) plan.shadowed.clear();
}

// After surfaces and lights.
void plan_shadows(const Scene& scene, const View& view, const TechniqueNeeds& needs,
                  PlannedInstances instances, FramePlan& plan) {
  if (plan.settings[setting::shadows] == ShadowMethod::none) {
    plan.decisions.push_back({"shadows", false, "shadows=none"});
    return;
  }
  if (needs.shadows) shadow_all(scene, plan);
  plan.casting = plan_light_shadows(scene, view, ranges_of(plan.settings), plan.opaque, plan.blended,
                                    soft_shadows(plan.settings) ? plan.settings[setting::shadow_source_m] : 0,
                                    blended_casters(plan.settings));
  if (!plan.settings[setting::everything_on])
    plan.dim_steps =
        leave_out_dim_lights(scene, view, plan.settings, plan.opaque, plan.blended, plan.casting);
  if (instances == PlannedInstances::in_view && plan.shadows) {
    plan.shadows = false;
    for (const LightShadow& light : plan.casting) {
      const bool rays = light.need == ShadowNeed::rays;
      plan.shadowed[place_of_light(plan, light.light)] = rays;
      plan.shadows = plan.shadows || rays;
    }
    if (!plan.shadows) plan.shadowed.clear();
  }
  plan.shadows_by = plan.settings[setting::shadows] == ShadowMethod::map ? "maps" : "rays";
  if (needs.own_shadows) take_own_shadows(scene, view, needs, plan);
  // Shadows of directional lights are found by the pass.
  if (!plan.own_shadowed.empty()) plan.shadows_by = needs.shadows_by;
  const auto rays = std::ranges::find(plan.casting, ShadowNeed::rays, &LightShadow::need);
  plan.decisions.push_back({"shadows", plan.shadows || !plan.own_shadowed.empty(),
                            plan.casting.empty() ? "no light casts one"
                            : !needs.shadows     ? needs.no_shadows
                            : rays != plan.casting.end()
                                ? fmt::format("{} reaches {}", light_witness(scene, rays->light),
                                              instance_witness(scene, rays->caster))
                                : fmt::format("{}: {}", light_witness(scene, plan.casting[0].light),
                                              reason_of(plan.casting[0].need))});
}

// From the near plane to the farthest surface in view.
void plan_slices(const View& view, const TechniqueNeeds& needs, double farthest_m, FramePlan& plan) {
  plan.slices = needs.slices ? plan.settings[setting::slices] : 1;
  const double far_m = std::min(farthest_m, view.far_m);
  plan.slice_near_m = view.near_m;
  plan.slice_far_m = far_m > view.near_m ? far_m : view.near_m + 1;
  plan.z_bins = needs.z_bins && plan.light_grid ? plan.settings[setting::z_bins] : 1;
  const bool needed = plan.light_grid && plan.slices > 1;
  plan.decisions.push_back(
      {"depth slices", needed,
       needed ? fmt::format("{} from {:.3g} m to {:.3g} m", plan.slices, plan.slice_near_m, plan.slice_far_m)
       : !needs.slices   ? needs.no_slices
       : plan.light_grid ? "slices=1"
                         : "no light grid"});
  plan.decisions.push_back({"z-bins", plan.z_bins > 1,
                            plan.z_bins > 1   ? fmt::format("{} between the same distances", plan.z_bins)
                            : !needs.z_bins   ? "the technique's shading reads none"
                            : plan.light_grid ? "z-bins=off"
                                              : "no light grid"});
}

// Names the shadows that are found for only one sample per pixel, if there are any here. After shadows.
const char* shadows_of_one_sample(const TechniqueNeeds& needs, const FramePlan& plan) {
  if (!plan.light_reaches && !plan.own_shadows) return nullptr;
  const Settings& s = plan.settings;
  return plan.opengl                                ? "shadows where OpenGL draws"
         : needs.stored_surfaces                    ? "shadows of stored surfaces"
         : s[setting::shadows] == ShadowMethod::map ? "shadow maps"
         : soft_shadows(s)                          ? "shadows of shadow-rays"
         : picks_shadows(s)                         ? "shadows of shadow-pick"
                                                    : nullptr;
}

// Why one sample a pixel is drawn, although the scene asks for more; empty: they are drawn. The same for
// every view of the scene.
std::string why_one_sample(const Scene& scene, const TechniqueNeeds& needs, const FramePlan& plan) {
  if (plan.settings.given(setting::samples))
    return fmt::format("samples={}", plan.settings[setting::samples]);
  if (scene.samples > needs.most_samples)
    return fmt::format("the technique with these settings takes {}", needs.most_samples);
  if (plan.opengl && !needs.opengl_samples) return "OpenGL on this machine cannot draw them";
  const char* of_one_sample = shadows_of_one_sample(needs, plan);
  return of_one_sample ? fmt::format("{} are found for one", of_one_sample) : "";
}

// After shadows.
void plan_samples(const Scene& scene, const TechniqueNeeds& needs, FramePlan& plan) {
  int samples = plan.settings[setting::samples];
  const bool own = samples > 1;
  if (!own && scene.samples > 1) {
    const std::string why_one = why_one_sample(scene, needs, plan);
    if (why_one.empty()) samples = scene.samples, plan.settings.set(setting::samples, samples);
    plan.decisions.push_back({"samples", why_one.empty(),
                              fmt::format("the scene asks for {} a pixel{}{}", scene.samples,
                                          why_one.empty() ? "" : "; ", why_one)});
  }
  if (samples == 1) return;
  if (own) plan.decisions.push_back({"samples", true, fmt::format("samples={}", samples)});
  const auto masked = std::ranges::find_if(
      plan.opaque, [&](int i) { return (plan.features_of_instance[size_t(i)] & feature_mask) != 0; });
  const bool at_samples = plan.settings[setting::samples_masks] != SampleMasks::centre;
  plan.decisions.push_back({"masks of samples", at_samples && masked != plan.opaque.end(),
                            !at_samples                   ? "samples-masks=centre"
                            : masked == plan.opaque.end() ? "no masked material in view"
                                                          : instance_witness(scene, *masked)});
  const char* of_one_sample = shadows_of_one_sample(needs, plan);
  if (!of_one_sample) return;
  const auto caster = std::ranges::find_if(scene.lights, &Light::casts_shadow);
  throw input_error(
      "set samples={}: light {} \"{}\" casts a shadow, and {} are found for one sample a "
      "pixel; choose samples=1 or shadows=none",
      samples, caster - scene.lights.begin(), caster->name, of_one_sample);
}

void turn_everything_on(const Scene& scene, const View& view, FramePlan& plan, const TechniqueNeeds& needs) {
  plan.light_grid = plan.blend_grid = needs.light_grid;
  plan.world_grid = needs.world_grid;
  plan.local_lights = plan.spots = plan.virtual_lights = plan.directional = plan.base_lighting = plan.blend =
      plan.mask = true;
  number_groups(scene, plan);
  plan_group_tiles(needs, plan);
  if (needs.shadows && plan.settings[setting::shadows] != ShadowMethod::none) {
    shadow_all(scene, plan);
    if (needs.own_shadows) take_own_shadows(scene, view, needs, plan);
    plan.light_reaches = true;
  }
  plan.index_bits = 32;
  plan.features = features_read(feature_all, plan.settings[setting::brdf]);
  plan.clearcoat = plan.features & feature_clearcoat;
  plan.skin = plan.minnaert = true;
  plan.specular = plan.features & feature_specular;
  for (int i : plan.opaque) plan.features_of_instance[i] = plan.features;
  for (int i : plan.blended) plan.features_of_instance[i] = plan.features;
}

}  // namespace

std::vector<std::string> defines_of(uint32_t features) {
  std::vector<std::string> defines;
  for (const FeatureName& f : feature_names) {
    if (features & f.bit) defines.emplace_back(f.define);
  }
  return defines;
}

uint32_t features_read(uint32_t features, Brdf brdf) {
  constexpr uint32_t of_lobes = feature_clearcoat | feature_clearcoat_map | feature_clearcoat_roughness_map |
                                feature_clearcoat_normal_map | feature_specular | feature_specular_map |
                                feature_specular_color_map;
  return brdf == Brdf::lambert ? features & ~of_lobes : features;
}

uint32_t material_features(const Scene& scene, const Mesh& mesh) {
  const Material& m = scene.materials[mesh.material];
  uint32_t features = 0;
  const auto use = [&](const TextureSlot& slot, uint32_t feature) {
    if (slot.texture < 0) return;
    features |= feature | feature_textured;
    if (slot.uv_set == 1) features |= feature_uv1;
    if (slot.transformed()) features |= feature_uv_transform;
  };
  use(m.base_color_map, feature_base_color_map);
  if (!mesh.colors.empty()) features |= feature_vertex_color;
  if (m.alpha_mode == AlphaMode::mask) features |= feature_mask;
  if (m.unlit) return features | feature_unlit;  // unlit surfaces need none of the features below
  use(m.metallic_roughness_map, feature_metallic_roughness_map);
  use(m.normal_map, feature_normal_map);
  use(m.occlusion_map, feature_occlusion_map);
  use(m.emissive_map, feature_emissive_map);
  if (m.model.skin()) features |= feature_skin;
  if (m.model.minnaert()) features |= feature_minnaert;
  if (has_specular(m)) {
    features |= feature_specular;
    use(m.specular_map, feature_specular_map);
    use(m.specular_color_map, feature_specular_color_map);
  }
  if (m.clearcoat == 0) return features;
  features |= feature_clearcoat;
  use(m.clearcoat_map, feature_clearcoat_map);
  use(m.clearcoat_roughness_map, feature_clearcoat_roughness_map);
  use(m.clearcoat_normal_map, feature_clearcoat_normal_map);
  return features;
}

bool draws_with_opengl(const TechniqueNeeds& needs, const Settings& settings) {
  return needs.opengl && !(needs.chosen_raster && settings[setting::raster] == RasterApi::opencl);
}

FramePlan plan_frame(const Scene& scene, const View& view, const Settings& settings, TechniqueNeeds needs,
                     PlannedInstances instances, PlannedLights lights) {
  FramePlan plan;
  plan.settings = settings;
  plan.planned_lights = lights;
  if (needs.adapt) needs.adapt(needs, plan.settings);
  plan.opengl = draws_with_opengl(needs, settings);
  plan.decisions.reserve(std::size(feature_names) + 16);
  plan.reversed_triangles = needs.reversed_triangles;
  plan.stencil = needs.stencil;
  if (needs.lists) plan.settings.set(setting::grid_lists, GridLists::lists);
  if (!needs.capped_lists) plan.settings.reset(setting::list_cap).reset(setting::view_cap);
  check_capped_lists(needs, plan.settings);
  const double farthest_m = plan_surfaces(scene, view, instances, plan);
  plan_models(scene, plan);
  plan_lights(scene, view, plan);
  plan_effects(scene, needs.effects, plan);
  plan_base_lighting(scene, plan);
  plan.light_grid = needs.light_grid && plan.local_lights;
  const bool bounded = settings[setting::depth_bounds] != DepthBoundsMode::none;
  plan.blend_grid = plan.light_grid && plan.blend && bounded;
  plan.decisions.push_back({"light grid", plan.light_grid,
                            !needs.light_grid    ? needs.no_light_grid
                            : !plan.local_lights ? "no light has a place"
                                                 : light_witness(scene, plan.local[0])});
  plan.decisions.push_back(
      {"blended light grid", plan.blend_grid,
       plan.blend_grid ? instance_witness(scene, *std::min_element(plan.blended.begin(), plan.blended.end()))
       : !plan.light_grid ? "no light grid"
       : !plan.blend      ? "no blended material in view"
                          : "without depth bounds, one grid serves all surfaces"});
  plan_sampled_lists(plan);
  plan.world_grid = needs.world_grid && plan.local_lights;
  if (needs.world_grid) {
    plan.decisions.push_back(
        {"world grid", plan.world_grid,
         plan.world_grid ? light_witness(scene, plan.local[0]) : "no light has a place"});
  }
  plan_slices(view, needs, farthest_m, plan);
  plan_groups(scene, needs, plan);
  plan_shadows(scene, view, needs, instances, plan);
  plan_samples(scene, needs, plan);
  plan.shadow_bytes =
      soft_shadows(settings) || picks_shadows(settings) ||
      (settings[setting::shadows] == ShadowMethod::map && settings[setting::shadow_taps] > 1) ||
      (plan.light_reaches && has_veils(scene, blended_casters(settings)));
  if (settings[setting::everything_on]) turn_everything_on(scene, view, plan, needs);
  return plan;
}

std::string describe(const FramePlan& plan, const Scene& scene) {
  const ShownCounts all = shown_counts(scene);
  std::string text = fmt::format("{} of {} instances in view ({} opaque, {} blended), {} of {} lights\n",
                                 plan.opaque.size() + plan.blended.size(), all.instances, plan.opaque.size(),
                                 plan.blended.size(), plan.lights_in_view, all.lights);
  for (const Decision& d : plan.decisions)
    text += fmt::format("  {} {}: {}\n", d.needed ? "yes" : " no", d.effect, d.why);
  text += describe_shadows(plan.casting, scene, plan.shadows_by);
  const std::string coarse = describe(coarse_shadows(scene, ranges_of(plan.settings)), scene);
  return coarse.empty() ? text : fmt::format("{}  {}\n", text, coarse);
}

}  // namespace lightgrid
