#include "passes/common/view_shadow_maps.h"

namespace lightgrid {

static ShadowMapOptions options_of(const Settings& settings) {
  return {.size = settings.shadow_size, .bits = settings.shadow_bits, .taps = settings.shadow_taps};
}

ViewShadowMaps::ViewShadowMaps(Work& work)
    : options_(options_of(work.plan.settings)), maps_(*work.renderer.cl, *work.renderer.kernels, options_) {}

void ViewShadowMaps::look(const Work& work, const glm::dvec3& origin) {
  const FramePlan& plan = work.plan;
  std::vector<Light> lights;
  for (size_t i = 0; i < plan.local.size(); ++i) {
    if (!plan.shadowed[i]) continue;
    const size_t number = size_t(plan.local[i]);
    Light& light = lights.emplace_back(work.scene.lights[number]);
    light.radius_m = float(range_of(light, number, plan.settings.ranges));
  }
  atlas_ = plan_shadow_atlas(lights, work.view, origin, world_box(work.scene), options_);
  // By number in FramePlan::local; those without shadows have no face, and no kernel asks for them.
  std::vector<std::array<uint32_t, 2>> by_number(plan.local.size());
  for (size_t i = 0, next = 0; i < plan.local.size(); ++i)
    if (plan.shadowed[i]) by_number[i] = atlas_.lights[next++];
  atlas_.lights = std::move(by_number);
}

}  // namespace lightgrid
