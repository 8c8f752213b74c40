#include "plan/mask_plan.h"

#include <algorithm>
#include <unordered_map>

#include "plan/settings/masks.h"
#include "plan/settings/surfaces.h"
#include "scene/scene.h"

namespace lightgrid {

// Each mask once, in the order of the first instances.
static void number_masks(const Scene& scene, MaskPlan& plan) {
  std::unordered_map<uint32_t, uint32_t> numbers;
  for (const Instance& instance : scene.instances) {
    const auto [number, is_new] = numbers.try_emplace(mask_of(instance), uint32_t(plan.values.size()));
    if (is_new) plan.values.push_back(number->first);
    plan.of_instance.push_back(number->second);
  }
}

void plan_every_mask(const Scene& scene, const MaskNeeds& needs, const Settings& settings, bool opengl,
                     const ListPlan& lists, MaskPlan& plan) {
  plan.values.clear();
  plan.of_instance.clear();
  plan.needed = true;
  number_masks(scene, plan);
  plan.tiles = lists.light_grid && needs.tiles && settings[setting::tile_masks] &&
               (!opengl || plan.values.size() <= size_t(1) << settings[setting::number_bits]);
}

MaskPlan plan_masks(const Scene& scene, std::span<const Effect* const> effects, const MaskNeeds& needs,
                    const Settings& settings, bool opengl, const ListPlan& lists) {
  MaskPlan plan;
  if (std::ranges::none_of(effects, [](const Effect* e) { return has_masks(*e); })) return plan;
  plan_every_mask(scene, needs, settings, opengl, lists, plan);
  if (needs.stencil)
    plan.stencil_bits =
        std::min(settings[setting::stencil_masks], max_stencil_masks(settings[setting::volume_culling]));
  return plan;
}

}  // namespace lightgrid
