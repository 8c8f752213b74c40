#include "renderer/light_table.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>

namespace lightgrid {
namespace {

constexpr double max_float = std::numeric_limits<float>::max();

// The columns' values for one light, by the names of LIGHT_TABLE.

glm::vec4 position(const ViewLight& light) {
  // A light without a range gets a range of 7e18 m. Past it the squared distance overflows float, and the
  // window is 0 instead of infinity times 0.
  const double inverse_radius_squared = std::clamp(1.0 / (light.radius_m * light.radius_m), 2e-38, 3e38);
  return {glm::vec3(glm::clamp(light.position, -max_float, max_float)), float(inverse_radius_squared)};
}

glm::vec4 color(const ViewLight& light) {
  // A light of radius 0 lights nothing, not even its own position.
  return {light.radius_m > 0 ? glm::vec3(light.radiant_intensity) : glm::vec3(0),
          float(std::min(light.least_falloff, max_float))};
}

glm::vec4 cone(const ViewLight& light) {
  if (!has_cone(light)) return {0, 0, 0, 1};
  // KHR_lights_punctual: clamp((cos(angle) - cos(outer)) / (cos(inner) - cos(outer)), 0, 1), as a product and
  // a sum.
  const double scale = 1.0 / (light.cos_inner - light.cos_outer);
  return {glm::vec3(light.direction * scale), float(-light.cos_outer * scale)};
}

// The conditions of LIGHT_TABLE.
constexpr bool FramePlan::*IF_LIGHTS = &FramePlan::local_lights;
constexpr bool FramePlan::*IF_SPOTS = &FramePlan::spots;

constexpr GLenum format_of(const glm::vec4&) { return GL_RGBA32F; }

template <typename T>
LightColumn column(T (*value)(const ViewLight&), bool needed, Sampler sampler,
                   std::span<const ViewLight> lights, const std::vector<int>& local) {
  LightColumn made{needed, sampler, format_of(T()), {}};
  if (!needed) return made;
  made.values.resize(local.size() * sizeof(T));
  for (size_t i = 0; i < local.size(); ++i) {
    const T of_light = value(lights[size_t(local[i])]);
    std::memcpy(made.values.data() + i * sizeof(T), &of_light, sizeof(T));
  }
  return made;
}

}  // namespace

LightTable light_table(const Scene& scene, const View& view, const FramePlan& plan) {
  const std::vector<ViewLight> lights = lights_in_view(scene, view, plan.settings.ranges);
#define LIGHT_COLUMN(condition, type, member, array, texels) \
  column(member, plan.*condition, Sampler::array, lights, plan.local),
  LightTable table{{LIGHT_TABLE(LIGHT_COLUMN)}, {}};
#undef LIGHT_COLUMN
  for (int i : plan.directional_lights) {
    table.directional.emplace_back(glm::vec3(-lights[i].direction), 0);
    table.directional.emplace_back(glm::vec3(lights[i].radiant_intensity), 0);
  }
  return table;
}

std::vector<const char*> light_table_defines(const FramePlan& plan) {
  std::vector<const char*> defines;
  if (plan.spots) defines.push_back("SPOTS");
  if (plan.light_reaches) defines.push_back("LIGHT_REACHES");
  const LightRanges& ranges = plan.settings.ranges;
  if (window_of(ranges) == RangeWindow::smooth) defines.push_back("WINDOW_SMOOTH");
  if (window_of(ranges) == RangeWindow::none) defines.push_back("WINDOW_NONE");
  if (ranges.range == LightRange::stochastic) defines.push_back("LEAST_FALLOFF");
  return defines;
}

}  // namespace lightgrid
