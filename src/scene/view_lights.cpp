#include "scene/view_lights.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {

std::vector<ViewLight> lights_in_view(const Scene& scene, const View& view, const LightRanges& ranges) {
  const glm::dmat3 rotation(view.view_from_world);
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
    out.least_falloff = least_falloff(light, ranges);
    out.cos_outer = std::cos(double(light.outer_cone_rad));
    // KHR_lights_punctual divides by max(0.001, cos(inner) - cos(outer)): a hard edge is softened, the
    // quotient finite.
    out.cos_inner = std::max(std::cos(double(light.inner_cone_rad)), out.cos_outer + 0.001);
  }
  return lights;
}

}  // namespace lightgrid
