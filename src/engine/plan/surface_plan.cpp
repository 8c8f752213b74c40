#include "plan/surface_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/settings/model.h"
#include "plan/visibility.h"
#include "scene/hidden.h"

namespace lightgrid {
namespace {

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

void plan_models(const Scene& scene, const Settings& settings, SurfacePlan& plan) {
  for (const Instance& instance : scene.instances) {
    const Material& m = scene.materials[scene.meshes[instance.mesh].material];
    if (m.unlit || m.alpha_mode == AlphaMode::blend) continue;
    plan.skin = plan.skin || m.model.skin();
    plan.minnaert = plan.minnaert || m.model.minnaert();
    plan.specular =
        plan.specular || (has_specular(m) && features_read(feature_specular, settings[setting::brdf]) != 0);
  }
}

}  // namespace

std::string instance_witness(const Scene& scene, int instance) {
  const Instance& i = scene.instances[instance];
  const int material = scene.meshes[i.mesh].material;
  return fmt::format("material {} \"{}\" on node {} \"{}\"", material, scene.materials[material].name,
                     instance, i.name);
}

std::string blend_witness(const Scene& scene, const SurfacePlan& surfaces) {
  return instance_witness(scene, *std::ranges::min_element(surfaces.blended));
}

int first_with_base_lighting(const Scene& scene, const SurfacePlan& surfaces) {
  const auto first =
      std::ranges::find_if(surfaces.opaque, [&](int i) { return shows_base_lighting(scene, i); });
  return first == surfaces.opaque.end() ? -1 : *first;
}

SurfacePlan plan_surfaces(const Scene& scene, const View& view, const Settings& settings,
                          PlannedInstances instances, Decisions& decisions) {
  SurfacePlan plan;
  const Frustum frustum = frustum_of(view);
  const auto planned = [&](int i, const glm::dmat4& to_view) {
    return instances == PlannedInstances::in_view
               ? !is_hidden(scene.instances[i]) &&
                     may_see_box(frustum, to_view, scene.meshes[scene.instances[i].mesh].bounds)
               : is_planned(scene, i, instances);
  };
  plan.features_of_instance.assign(scene.instances.size(), 0);
  std::vector<int> first_with(feature_names.size(), -1);
  std::vector<std::pair<double, int>> blended;
  plan.farthest_m = view.near_m;
  for (int i = 0; i < int(scene.instances.size()); ++i) {
    const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
    const glm::dmat4 to_view = view_from_object(view, scene.instances[i].world_from_object);
    if (mesh.indices.empty() || !planned(i, to_view)) continue;
    const uint32_t features = features_read(material_features(scene, mesh), settings[setting::brdf]);
    plan.farthest_m = std::max(plan.farthest_m, farthest_of_box(to_view, mesh.bounds));
    plan.features_of_instance[i] = features;
    plan.features |= features;
    for (size_t f = 0; f < feature_names.size(); ++f) {
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
  decisions.push_back(
      {"blend", plan.blend, plan.blend ? blend_witness(scene, plan) : "no blended material in view"});
  for (size_t f = 0; f < feature_names.size(); ++f) {
    const bool left_out = features_read(feature_names[f].bit, settings[setting::brdf]) == 0;
    decisions.push_back({feature_names[f].effect, first_with[f] >= 0,
                         first_with[f] >= 0 ? instance_witness(scene, first_with[f])
                         : left_out         ? "brdf=lambert has no lobes"
                                            : "no material in view has any"});
  }
  plan_models(scene, settings, plan);
  return plan;
}

void plan_every_feature(const Settings& settings, SurfacePlan& plan) {
  plan.base_lighting = plan.blend = plan.mask = true;
  plan.features = features_read(feature_all, settings[setting::brdf]);
  plan.clearcoat = plan.features & feature_clearcoat;
  plan.skin = plan.minnaert = true;
  plan.specular = plan.features & feature_specular;
  for (int i : plan.opaque) plan.features_of_instance[i] = plan.features;
  for (int i : plan.blended) plan.features_of_instance[i] = plan.features;
}

}  // namespace lightgrid
