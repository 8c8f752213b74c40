#include "oracle/attenuation.h"

#include <algorithm>

namespace lightgrid::lab {

namespace {

double window_at(const ViewLight& light, double distance) {
  if (light.window == RangeWindow::none) return 1;
  const double ratio = distance / light.radius_m;
  const double khr = std::clamp(1 - ratio * ratio * ratio * ratio, 0.0, 1.0);
  return light.window == RangeWindow::smooth ? khr * khr : khr;
}

// The probability with which a light with random ranges reaches a point of this 1 / distance^2 (Tokuyoshi and
// Harada 2016).
double probability(const ViewLight& light, double falloff) {
  return light.min_falloff > 0 ? std::min(falloff / light.min_falloff, 1.0) : 1;
}

}  // namespace

double attenuation(const ViewLight& light, const glm::dvec3& position, bool window) {
  if (is_directional(light)) return 1;
  const glm::dvec3 offset = position - light.position;
  const double distance = length_of(offset.x, offset.y, offset.z);
  double result = 1 / std::max(distance * distance, std::numeric_limits<double>::min());
  const bool by_cosine = light.max_falloff > 0;  // a virtual light
  if (by_cosine) result = std::min(result, light.max_falloff);
  if (window && std::isfinite(light.radius_m)) {
    if (!(distance < light.radius_m)) return 0;  // before the ratio, which is 0 / 0 for a light of radius 0
    result *= window_at(light, distance) / probability(light, result);
  }
  if (has_cone(light)) {
    const double cosine = cos_from_axis(light, offset, distance);
    const double t = std::clamp((cosine - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
    result *= by_cosine ? t : t * t;
  }
  return result;
}

}  // namespace lightgrid::lab
