#include "plan/light_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "plan/settings/grid.h"
#include "plan/settings/groups.h"
#include "plan/settings/model.h"
#include "plan/settings/surfaces.h"
#include "plan/visibility.h"
#include "scene/hidden.h"
#include "scene/light_groups.h"

namespace lightgrid {
namespace {

// Leaves out all lights but the nearest of those whose range the view sees, `seen` by index into `local`.
void cap_view(const std::vector<ViewLight>& lights, std::vector<size_t> seen, FramePlan& plan) {
  const size_t cap = size_t(plan.settings[setting::view_cap]);
  if (cap == 0) return;
  if (seen.size() > cap) {
    std::ranges::stable_sort(seen, {}, [&](size_t i) {
      const glm::dvec3& p = lights[size_t(plan.local[i])].position;
      return glm::dot(p, p);
    });
    plan.left_out.assign(plan.local.size(), 1);
    for (size_t i = 0; i < cap; ++i) plan.left_out[seen[i]] = 0;
  }
  plan.decisions.push_back({"view cap", seen.size() > cap,
                            fmt::format("view-cap={}, {} point and spot lights in view", cap, seen.size())});
}

// The first light or instance that lacks a group, and how many there are of both.
std::string group_witness(const Scene& scene, size_t masks) {
  const auto lacks = [](const auto& owner) { return owner.groups != all_groups; };
  const auto light = std::ranges::find_if(scene.lights, lacks);
  const auto instance = std::ranges::find_if(scene.instances, lacks);
  const std::string first =
      light != scene.lights.end()
          ? fmt::format("{} has {}", light_witness(scene, int(light - scene.lights.begin())),
                        words_of_groups(scene, light->groups))
          : fmt::format("node {} \"{}\" has {}", instance - scene.instances.begin(), instance->name,
                        words_of_groups(scene, instance->groups));
  return fmt::format("{}; {} of {} lights and {} of {} instances lack a group, which have {} different masks",
                     first, std::ranges::count_if(scene.lights, lacks), scene.lights.size(),
                     std::ranges::count_if(scene.instances, lacks), scene.instances.size(), masks);
}

void check_sampled_lists(const TechniqueNeeds& needs, const Settings& s) {
  if (!samples_lists(s)) return;
  const bool tree = s[setting::list_cap_order] == ListCapOrder::tree;
  if (!needs.sampled_lists)
    throw input_error(
        "set list-cap-order={}: the technique's lists do not say how many times a light counts; choose "
        "forward_plus, clustered, forward_plus_compute, deferred_tiled or visibility, or another order",
        tree ? "tree" : "sampled");
  if (tree && needs.z_bins && s[setting::z_bins] > 1)
    throw input_error(
        "set z-bins={}: with list-cap-order=tree no light is sorted into bins; choose z-bins=off",
        s[setting::z_bins]);
  if (tree && s[setting::view_cap] > 0)
    throw input_error("set view-cap={}: list-cap-order=tree draws from all lights; choose view-cap=off",
                      s[setting::view_cap]);
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

void plan_lights(const Scene& scene, const View& view, FramePlan& plan) {
  const Frustum frustum = frustum_of(view);
  const std::vector<ViewLight> lights = lights_in_view(scene, view, ranges_of(plan.settings));
  std::vector<size_t> seen_local;
  int first_spot = -1, first_virtual = -1;
  for (int i = 0; i < int(lights.size()); ++i) {
    const bool directional = is_directional(lights[i]);
    (directional ? plan.directional_lights : plan.local).push_back(i);
    const bool in_view = may_see_sphere(frustum, lights[i].position, lights[i].radius_m);
    const bool seen = directional || counts_as_seen(plan.planned_lights, lights[i], in_view);
    plan.lights_in_view += seen && !is_hidden(scene.lights[size_t(i)]);
    if (seen && !directional) seen_local.push_back(plan.local.size() - 1);
    // A spot out of view still needs its cone: the cone makes its contribution zero in view.
    if (has_cone(lights[i]) && first_spot < 0) first_spot = i;
    if (!scene.lights[size_t(i)].is_virtual) continue;
    if (plan.virtual_count++ == 0) first_virtual = i;
  }
  plan.local_lights = !plan.local.empty();
  plan.spots = first_spot >= 0;
  plan.virtual_lights = plan.virtual_count > 0;
  plan.directional = !plan.directional_lights.empty();
  plan.index_bits = plan.local.size() <= 65536 ? 16 : 32;
  const auto& local = plan.local;
  plan.decisions.push_back({"point and spot lights", plan.local_lights,
                            plan.local_lights ? light_witness(scene, local[0]) : "no light has a place"});
  plan.decisions.push_back(
      {"spot cones", plan.spots, plan.spots ? light_witness(scene, first_spot) : "no light is a spot"});
  plan.decisions.push_back({"virtual lights", plan.virtual_lights,
                            plan.virtual_lights
                                ? fmt::format("{} of {} lights, the first of them {}", plan.virtual_count,
                                              lights.size(), light_witness(scene, first_virtual))
                                : "no light is virtual"});
  plan.decisions.push_back(
      {"directional lights", plan.directional,
       plan.directional ? light_witness(scene, plan.directional_lights[0]) : "no light is directional"});
  plan.decisions.push_back(
      {"32-bit light indices", plan.index_bits == 32, fmt::format("{} point and spot lights", local.size())});
  cap_view(lights, std::move(seen_local), plan);
}

void check_capped_lists(const TechniqueNeeds& needs, const Settings& s) {
  if (needs.light_grid && s[setting::list_cap] > 0 && s[setting::grid_lists] == GridLists::masks)
    throw input_error(
        "set list-cap={}: masks have a bit for each light, and no length; choose grid-lists=lists, or "
        "view-cap",
        s[setting::list_cap]);
  if (needs.capped_lists) check_sampled_lists(needs, s);
}

void plan_sampled_lists(FramePlan& plan) {
  if (!samples_lists(plan.settings)) return;
  plan.sampled_lists = plan.light_grid && plan.local.size() > size_t(plan.settings[setting::list_cap]);
  plan.decisions.push_back({"sampled lists", plan.sampled_lists,
                            fmt::format("list-cap={}, {} point and spot lights",
                                        plan.settings[setting::list_cap], plan.local.size())});
  plan.light_tree = plan.sampled_lists && plan.settings[setting::list_cap_order] == ListCapOrder::tree;
  plan.decisions.push_back({"light tree", plan.light_tree,
                            plan.light_tree      ? "list-cap-order=tree, in place of culling"
                            : plan.sampled_lists ? "list-cap-order=sampled"
                                                 : "nothing is drawn"});
}

void number_groups(const Scene& scene, FramePlan& plan) {
  plan.groups = true;
  InstanceMasks masks = instance_masks(scene);
  plan.group_masks = std::move(masks.masks), plan.group_of_instance = std::move(masks.of_instance);
}

void plan_group_tiles(const TechniqueNeeds& needs, FramePlan& plan) {
  const Settings& s = plan.settings;
  plan.group_tiles = plan.groups && plan.light_grid && needs.group_tiles && s[setting::group_tiles] &&
                     (!plan.opengl || plan.group_masks.size() <= size_t(1) << s[setting::group_bits]);
}

void plan_groups(const Scene& scene, const TechniqueNeeds& needs, FramePlan& plan) {
  if (calls_for_groups(scene)) number_groups(scene, plan);
  if (plan.groups && needs.group_stencil) {
    plan.group_stencil = std::min(plan.settings[setting::group_stencil],
                                  most_stencil_groups(plan.settings[setting::volume_culling]));
    plan.stencil = plan.stencil || plan.group_stencil > 0;
  }
  plan_group_tiles(needs, plan);
  plan.decisions.push_back({"light groups", plan.groups,
                            plan.groups ? group_witness(scene, plan.group_masks.size()) + needs.groups_of
                                        : "not called for: every light and every instance has all groups"});
}

}  // namespace lightgrid
