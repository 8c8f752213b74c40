#include "renderer/light_texels.h"

#include <algorithm>
#include <limits>

namespace lightgrid {

constexpr double max_float = std::numeric_limits<float>::max();

std::vector<const char*> range_defines(const LightRanges& ranges) {
  std::vector<const char*> defines;
  if (window_of(ranges) == RangeWindow::smooth) defines.push_back("WINDOW_SMOOTH");
  if (window_of(ranges) == RangeWindow::none) defines.push_back("WINDOW_NONE");
  if (ranges.range == LightRange::stochastic) defines.push_back("LEAST_FALLOFF");
  return defines;
}

LightTexels light_texels(const Scene& scene, const View& view, const FramePlan& plan) {
  const std::vector<ViewLight> lights = lights_in_view(scene, view, plan.settings.ranges);
  LightTexels texels;
  for (int i : plan.local) {
    const ViewLight& light = lights[i];
    // A light without a range gets a range of 7e18 m. Past it the squared distance overflows float, and the
    // window is 0 instead of infinity times 0.
    const double inverse_radius_squared = std::clamp(1.0 / (light.radius_m * light.radius_m), 2e-38, 3e38);
    const glm::dvec3 position = glm::clamp(light.position, -max_float, max_float);
    texels.positions.emplace_back(glm::vec3(position), float(inverse_radius_squared));
    // A light of radius 0 lights nothing, not even its own position.
    const double least_falloff = std::min(light.least_falloff, max_float);
    texels.colors.emplace_back(light.radius_m > 0 ? glm::vec3(light.radiant_intensity) : glm::vec3(0),
                               float(least_falloff));
    if (!plan.spots) continue;
    // KHR_lights_punctual: clamp((cos(angle) - cos(outer)) / (cos(inner) - cos(outer)), 0, 1), as a product
    // and a sum.
    const double scale = 1.0 / (light.cos_inner - light.cos_outer);
    texels.cones.push_back(light.type == LightType::spot ? glm::vec4(glm::vec3(light.direction * scale),
                                                                     float(-light.cos_outer * scale))
                                                         : glm::vec4(0, 0, 0, 1));
  }
  for (int i : plan.directional_lights) {
    texels.directional.emplace_back(glm::vec3(-lights[i].direction), 0);
    texels.directional.emplace_back(glm::vec3(lights[i].radiant_intensity), 0);
  }
  return texels;
}

}  // namespace lightgrid
