#include "scene/view_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightgrid {

double cone_cosine(float half_angle_rad) {
  if (half_angle_rad == std::numbers::pi_v<float> / 2) return 0;
  if (half_angle_rad >= std::numbers::pi_v<float>) return -1;
  return std::cos(double(half_angle_rad));
}

std::vector<ViewLight> lights_in_view(const Scene& scene, const View& view, const LightRanges& ranges) {
  const glm::dmat3 rotation(view.view_from_world);
  // Most lights have the angles of the light before them.
  float outer_rad = 0, inner_rad = 0;
  double cos_outer = 1, cos_inner = 1;
  std::vector<ViewLight> lights;
  lights.reserve(scene.lights.size());
  for (const Light& light : scene.lights) {
    ViewLight& out = lights.emplace_back();
    out.type = light.type;
    out.position = rotation * (light.position - view.eye);
    out.direction = glm::normalize(rotation * glm::dvec3(light.direction));
    out.radiant_intensity = glm::dvec3(light.color) * double(light.intensity);
    out.radius_m = range_of(light, lights.size() - 1, ranges);
    out.window = window_of(ranges);
    out.min_falloff = min_falloff(light, ranges);
    out.mask = mask_of(light);
    out.reach = reach_terms(scene, light, ranges, view);
    out.share = share_of(scene, light, ranges);
    out.lit = lit_term(scene, light, ranges, rotation);
    if (light.is_virtual) out.max_falloff = max_falloff(light);
    if (light.outer_cone_rad != outer_rad) {
      outer_rad = light.outer_cone_rad;
      cos_outer = cone_cosine(outer_rad);
    }
    if (light.inner_cone_rad != inner_rad) {
      inner_rad = light.inner_cone_rad;
      cos_inner = cone_cosine(inner_rad);
    }
    const bool hard = light.inner_cone_rad >= light.outer_cone_rad;
    out.cos_outer = cos_outer;
    out.cos_inner = hard ? cos_outer + hard_edge : std::max(cos_inner, cos_outer + softest_edge);
    // Rounding would leave the axis of a cone without width.
    if (has_cone(light) && cos_outer == 1) out.radius_m = 0;
    // A hard edge at 180 degrees is none, and would be a point that rounding makes visible.
    if (has_cone(light) && hard && cos_outer == -1) out.type = LightType::point;
  }
  return lights;
}

std::vector<ViewLight> lights_in_view(const Scene& scene, const View& view, const LightRanges& ranges,
                                      const std::vector<int>& indices) {
  const std::vector<ViewLight> all = lights_in_view(scene, view, ranges);
  std::vector<ViewLight> lights;
  lights.reserve(indices.size());
  for (const int i : indices) lights.push_back(all[size_t(i)]);
  return lights;
}

double LightBounds::widened_angle_rad() const { return std::acos(std::clamp(cos_outer - 1e-6, -1.0, 1.0)); }

LightBounds bounds_of(const Light& light, double range_m) {
  return {light.position, range_m, glm::normalize(glm::dvec3(light.direction)),
          has_cone(light) ? cone_cosine(light.outer_cone_rad) : -1.0};
}

LightBounds bounds_of(const ViewLight& light) {
  return {light.position, light.radius_m, light.direction, has_cone(light) ? light.cos_outer : -1.0};
}

}  // namespace lightgrid
