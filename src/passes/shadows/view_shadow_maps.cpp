#include "passes/shadows/view_shadow_maps.h"

#include "base/error.h"

namespace lightgrid {

static ShadowMapOptions options_of(const Settings& settings) {
  return {.size = settings.shadow_size,
          .bits = settings.shadow_bits,
          .taps = settings.shadow_taps,
          .most_bytes = settings.shadow_memory};
}

ViewShadowMaps::ViewShadowMaps(Work& work)
    : options_(options_of(work.plan.settings)), maps_(*work.renderer.cl, *work.renderer.kernels, options_) {}

void ViewShadowMaps::look(const Work& work, const glm::dvec3& origin) {
  const FramePlan& plan = work.plan;
  std::vector<size_t> numbers(plan.local.begin(), plan.local.end());
  numbers.insert(numbers.end(), plan.directional_lights.begin(), plan.directional_lights.end());
  std::vector<Light> lights;
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!plan.shadowed[i]) continue;
    Light& light = lights.emplace_back(work.scene.lights[numbers[i]]);
    light.radius_m = float(range_of(light, numbers[i], plan.settings.ranges));
  }
  atlas_ = plan_shadow_atlas(lights, work.view, origin, world_box(work.scene), options_);
  if (atlas_.bytes > options_.most_bytes)
    throw input_error(
        "shadow maps: {} faces of {} x {} texels need {} bytes, more than shadow-memory allows ({}): raise "
        "it, "
        "or let fewer lights cast",
        atlas_.faces.size(), least_shadow_size, least_shadow_size, atlas_.bytes, options_.most_bytes);
  // In the order of FramePlan::shadowed; those without shadows have no face, and no kernel asks for them.
  std::vector<std::array<uint32_t, 2>> by_number(numbers.size());
  for (size_t i = 0, next = 0; i < numbers.size(); ++i)
    if (plan.shadowed[i]) by_number[i] = atlas_.lights[next++];
  atlas_.lights = std::move(by_number);
}

}  // namespace lightgrid
