#include "passes/shadows/view_shadow_maps.h"

#include <algorithm>
#include <cstring>

#include "base/error.h"
#include "plan/settings/kernels.h"
#include "plan/settings/model.h"
#include "plan/settings/shadows.h"

namespace lightgrid {
namespace {

// Returns whether a face may show the contents of the box. slack: rounding of positions to float.
bool may_see(const ShadowFace& face, const WorldBox& box, const glm::dvec3& origin) {
  if (box.empty()) return false;
  if (face.parallel) return true;
  const glm::dvec3 from = glm::dvec3(face.from[0], face.from[1], face.from[2]) + origin;
  const double farthest = glm::length(glm::max(glm::abs(box.min - origin), glm::abs(box.max - origin)));
  const double slack = 1e-5 * (farthest + glm::length(from - origin));
  return glm::length(from - glm::clamp(from, box.min, box.max)) <= 1.001 * double(face.range_m) + slack;
}

}  // namespace

static ShadowMapOptions options_of(const Settings& settings, int taps, size_t max_bytes) {
  return {.size = settings[setting::shadow_size],
          .bits = settings[setting::shadow_bits],
          .taps = taps,
          .max_bytes = std::min(settings[setting::shadow_memory], max_bytes),
          .shape = settings[setting::kernel_shape]};
}

ViewShadowMaps::ViewShadowMaps(PassContext& work, int taps, size_t max_bytes)
    : options_(options_of(work.plan.settings, taps, max_bytes)),
      maps_(*work.renderer.cl, *work.renderer.kernels, options_) {}

void ViewShadowMaps::look(const PassContext& work, const RayScene& rays, const std::vector<uint8_t>& shadowed,
                          bool keeps) {
  const glm::dvec3 origin = rays.origin();
  const FramePlan& plan = work.plan;
  std::vector<size_t> numbers(plan.lights.local.begin(), plan.lights.local.end());
  numbers.insert(numbers.end(), plan.lights.directional.begin(), plan.lights.directional.end());
  std::vector<Light> lights;
  for (size_t i = 0; i < numbers.size(); ++i) {
    if (!shadowed[i]) continue;
    Light& light = lights.emplace_back(work.scene.lights[numbers[i]]);
    light.radius_m = float(range_of(light, numbers[i], ranges_of(plan.settings)));
  }
  const std::vector<ShadowFace> before = std::move(atlas_.faces);
  atlas_ = plan_shadow_atlas(lights, work.view, origin, world_box(work.scene), options_);
  if (atlas_.bytes > options_.max_bytes)
    throw input_error(
        "shadow maps: {} faces of {} x {} texels need {} bytes, more than shadow-memory allows ({}): raise "
        "it, or let fewer lights cast",
        atlas_.faces.size(), min_shadow_size, min_shadow_size, atlas_.bytes, options_.max_bytes);
  // In the order of ShadowPlan::shadowed; those without shadows have no face, and no kernel reads one.
  std::vector<std::array<uint32_t, 2>> by_number(numbers.size());
  for (size_t i = 0, next = 0; i < numbers.size(); ++i)
    if (shadowed[i]) by_number[i] = atlas_.lights[next++];
  atlas_.lights = std::move(by_number);

  keeps_ = keeps;
  const auto moved = keeps_ ? moved_.since_last(work.gpu, rays) : std::nullopt;
  if (!moved) kept_.clear();
  kept_.resize(std::min(kept_.size(), atlas_.faces.size()));
  for (size_t i = 0; i < kept_.size(); ++i) {
    const ShadowFace& face = atlas_.faces[i];
    const auto sees = [&](const WorldBox& box) { return may_see(face, box, origin); };
    kept_[i] &= std::memcmp(&before[i], &face, sizeof face) == 0 && std::ranges::none_of(*moved, sees);
  }
}

void ViewShadowMaps::draw(const RayScene& rays, const cl::Buffer& texels) {
  if (texels()) kept_.clear();
  const auto is_drawn = [&](const std::array<uint32_t, 2>& light) {
    const auto [first, count] = light;
    for (uint32_t face = first; face < first + count; ++face)
      if (face >= kept_.size() || !kept_[face]) return true;
    return false;
  };
  drawn_lights_ = size_t(std::ranges::count_if(atlas_.lights, is_drawn));
  maps_.draw(rays, atlas_, kept_, texels);
  if (keeps_) kept_.assign(atlas_.faces.size(), 1);
}

}  // namespace lightgrid
