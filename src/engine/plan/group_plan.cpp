#include "plan/group_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "plan/light_plan.h"
#include "plan/settings/groups.h"
#include "plan/settings/surfaces.h"
#include "scene/light_groups.h"

namespace lightgrid {
namespace {

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

}  // namespace

void plan_every_group(const Scene& scene, const GroupNeeds& needs, const Settings& settings, bool opengl,
                      const ListPlan& lists, GroupPlan& plan) {
  plan.needed = true;
  InstanceMasks masks = instance_masks(scene);
  plan.masks = std::move(masks.masks), plan.of_instance = std::move(masks.of_instance);
  plan.tiles = lists.light_grid && needs.tiles && settings[setting::group_tiles] &&
               (!opengl || plan.masks.size() <= size_t(1) << settings[setting::group_bits]);
}

GroupPlan plan_groups(const Scene& scene, const GroupNeeds& needs, const Settings& settings, bool opengl,
                      const ListPlan& lists, Decisions& decisions) {
  GroupPlan plan;
  if (calls_for_groups(scene)) plan_every_group(scene, needs, settings, opengl, lists, plan);
  if (plan.needed && needs.stencil)
    plan.stencil_bits =
        std::min(settings[setting::group_stencil], most_stencil_groups(settings[setting::volume_culling]));
  decisions.push_back({"light groups", plan.needed,
                       plan.needed ? group_witness(scene, plan.masks.size()) + needs.of
                                   : "not called for: every light and every instance has all groups"});
  return plan;
}

}  // namespace lightgrid
