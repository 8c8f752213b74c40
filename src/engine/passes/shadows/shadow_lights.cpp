#include "passes/shadows/shadow_lights.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <limits>

#include "plan/settings/model.h"
#include "plan/settings/shadows.h"
#include "renderer/upload/culler_input.h"
#include "shared/shadow_bits.h"

namespace lightgrid {
namespace {

// Positions in view space are floats; they are turned to world axes and rounded again. Shading computes with
// other roundings of them. Points in range are no further from the eye and from the origin than the light and
// its range, and all of these errors together are below 2^-19 of that.
ShadowLight shadow_light(const CullLight& light, const View& view, const glm::dvec3& origin) {
  const glm::dvec3 at = light.position - origin;
  ShadowLight s{at.x,
                at.y,
                at.z,
                1,
                float(light.direction.x),
                float(light.direction.y),
                float(light.direction.z),
                float(light.cos_outer),
                0,
                0,
                float(light.radius_m)};
  if (light.cos_outer < -1) s.cos_outer = -1;
  const double slack =
      0x1p-19 * (glm::length(at) + glm::length(light.position - view.eye) + 2 * light.radius_m);
  const double reach = light.radius_m * (1 + 1e-5) + slack;
  s.reach_squared = float(std::min(reach * reach, double(std::numeric_limits<float>::infinity())));
  s.slack = float(std::min(slack, double(std::numeric_limits<float>::max())));
  return s;
}

ShadowLight shadow_light(const Light& directional) {
  const glm::dvec3 to_light = -glm::normalize(glm::dvec3(directional.direction));
  constexpr float everywhere = std::numeric_limits<float>::infinity();
  return {to_light.x, to_light.y, to_light.z, 0, 0, 0, 0, -1, everywhere, 0, {}};
}

}  // namespace

size_t shadow_light_count(const FramePlan& plan) {
  return plan.lights.local.size() + plan.lights.directional.size();
}

size_t shadow_table_words(const FramePlan& plan) { return (shadow_light_count(plan) + 31) / 32; }

size_t shadow_entry_bytes(const FramePlan& plan) {
  return (plan.shadows.bytes ? SHADOW_WORDS_OF_BYTES : SHADOW_WORDS_OF_BITS) * sizeof(uint32_t);
}

std::vector<CullLight> shining_lights(const ViewState& seen) {
  std::vector<CullLight> lights =
      cull_lights_of(seen.scene, seen.plan.lights.local, ranges_of(seen.plan.settings));
  for (const int i : seen.plan.lights.directional)
    lights.push_back({.direction = glm::dvec3(seen.scene.lights[size_t(i)].direction)});
  return lights;
}

std::vector<CullLight> shadowed_lights(const ViewState& seen, std::vector<CullLight> lights) {
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!seen.plan.shadows.shadowed[i]) lights[i].radius_m = -1;
  }
  return lights;
}

std::vector<ShadowLight> shadow_light_records(const ViewState& seen, const std::vector<CullLight>& shadowed,
                                              const glm::dvec3& origin) {
  const Settings& settings = seen.plan.settings;
  std::vector<ShadowLight> records;
  for (size_t i = 0; i < seen.plan.lights.local.size(); ++i) {
    ShadowLight& record = records.emplace_back(shadow_light(shadowed[i], seen.view, origin));
    const Light& light = seen.scene.lights[size_t(seen.plan.lights.local[i])];
    if (soft_shadows(settings)) record.source_m = float(source_of(light, settings[setting::shadow_source_m]));
    record.mask = mask_of(light);
    record.luminance = light.intensity * glm::dot(light.color, glm::vec3(0.2126f, 0.7152f, 0.0722f)) *
                       float(share_of(seen.scene, light, ranges_of(settings)).largest);
  }
  for (const int i : seen.plan.lights.directional)
    records.push_back(shadow_light(seen.scene.lights[size_t(i)]));
  for (size_t i = 0; i < records.size(); ++i)
    if (shadowed[i].radius_m < 0) records[i].reach_squared = -1;
  return records;
}

bool have_same_shadows(const ShadowLight& a, const ShadowLight& b) {
  return std::memcmp(&a, &b, offsetof(ShadowLight, luminance)) == 0;
}

ShadowView shadow_view(const ViewState& seen, const glm::dvec3& origin) {
  const View& view = seen.view;
  const glm::dmat3 world_from_view = glm::transpose(glm::dmat3(view.view_from_world));
  const glm::dvec3 from = view.eye - origin, eye = view.orthographic ? world_from_view[2] : from;
  ShadowView v{eye.x,         eye.y, eye.z, view.orthographic ? 0.0 : 1.0, {}, float(from.x), float(from.y),
               float(from.z), 0,     0};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      v.world_from_view[3 * row + column] = float(world_from_view[column][row]);
  }
  v.words = uint(shadow_table_words(seen.plan));
  return v;
}

ShadowInputs shadow_inputs(PassContext& work, const RayScene& rays) {
  ShadowInputs inputs{work.view, work.scene.lights, shining_lights(work), work.plan.shadows.shadowed,
                      {},        rays.builds()};
  for (const Instance& i : work.scene.instances)
    inputs.instances.emplace_back(i.world_from_object, work.gpu.mesh_version(i.mesh));
  return inputs;
}

}  // namespace lightgrid
