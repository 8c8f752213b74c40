#include "scene/shadow_casters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/light_ranges.h"
#include "scene/view_lights.h"

namespace lightgrid {

double light_importance(const Light& light, double scene_diameter_m) {
  const double intensity = brightest_intensity(light);
  if (is_directional(light)) return intensity * std::numbers::pi / 6 * std::pow(scene_diameter_m, 3);
  const double cos_outer = has_cone(light) ? cone_cosine(light.outer_cone_rad) : -1;
  const double solid_angle = 2 * std::numbers::pi * (1 - cos_outer);
  return intensity * solid_angle * std::min(double(light.radius_m), scene_diameter_m);
}

void choose_shadow_casters(Scene& scene, size_t count) {
  const WorldBox box = world_box(scene);
  const double diameter_m = box.empty() ? 0 : glm::length(box.max - box.min);
  std::vector<std::pair<double, size_t>> ranked;
  for (size_t i = 0; i < scene.lights.size(); ++i)
    ranked.emplace_back(-light_importance(scene.lights[i], diameter_m), i);
  std::ranges::sort(ranked);
  for (size_t rank = 0; rank < ranked.size(); ++rank)
    scene.lights[ranked[rank].second].casts_shadow = rank < count;
}

}  // namespace lightgrid
