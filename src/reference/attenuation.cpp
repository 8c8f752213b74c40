#include "reference/attenuation.h"

#include <algorithm>

namespace lightgrid {

double attenuation(const ViewLight& light, const glm::dvec3& position, bool window) {
  if (light.type == LightType::directional) return 1;
  const glm::dvec3 offset = position - light.position;
  const double distance = length_of(offset.x, offset.y, offset.z);
  double result = 1 / std::max(distance * distance, std::numeric_limits<double>::min());
  if (window && std::isfinite(light.radius_m)) {
    if (!(distance < light.radius_m)) return 0;  // before the ratio, which is 0 / 0 for a light of radius 0
    const double ratio = distance / light.radius_m;
    result *= std::clamp(1 - ratio * ratio * ratio * ratio, 0.0, 1.0);
  }
  if (light.type == LightType::spot) {
    const double cosine = cos_from_axis(light, offset, distance);
    const double t = std::clamp((cosine - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
    result *= t * t;
  }
  return result;
}

}  // namespace lightgrid
