#include "culling/light_arrays.h"

#include <algorithm>
#include <cmath>

namespace lightgrid {
namespace {

// A light has a place and a radius; what has none is listed nowhere.
bool is_light(const CullLight& light) {
  return light.radius_m >= 0 && std::isfinite(light.position.x) && std::isfinite(light.position.y) &&
         std::isfinite(light.position.z);
}

// An actual coordinate of some light, so that moving all by an exact amount moves it by that amount; in the middle, so
// that a few lights far off cost the others no precision.
double middle(std::span<const CullLight> lights, int axis) {
  std::vector<double> values;
  values.reserve(lights.size());
  for (const CullLight& light : lights) {
    if (is_light(light)) values.push_back(light.position[axis]);
  }
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

struct UploadedSphere {
  glm::vec3 place{0};
  float radius = -far_away;  // listed nowhere
};

// Of its place's rounding the radius makes up. Past what kernels call infinite only a light as large can reach a cell.
UploadedSphere uploaded_sphere(const CullLight& light, const glm::dvec3& origin) {
  if (!is_light(light)) return {};
  const glm::dvec3 place = light.position - origin;
  const double size = std::abs(place.x) + std::abs(place.y) + std::abs(place.z);
  if (!(size < far_away)) {
    return light.radius_m > size / 4 ? UploadedSphere{glm::vec3(0), std::numeric_limits<float>::infinity()} : UploadedSphere{};
  }
  const float grown = float(std::min(light.radius_m + half_ulp * size, 3e38));
  const float radius = std::isinf(light.radius_m) ? std::numeric_limits<float>::infinity()
                       : grown > 0                ? std::nextafter(grown, std::numeric_limits<float>::infinity())
                                                  : 0.0f;
  return {glm::vec3(place), radius};
}

}  // namespace

glm::dvec3 middle_of(std::span<const CullLight> lights) { return {middle(lights, 0), middle(lights, 1), middle(lights, 2)}; }

std::vector<float> light_arrays(std::span<const CullLight> lights, const glm::dvec3& origin, size_t stride) {
  std::vector<float> values(world_arrays * stride);
  std::fill_n(values.begin() + 3 * stride, stride, -far_away);  // those past the last
  for (size_t i = 0; i < lights.size(); ++i) {
    const CullLight& light = lights[i];
    const UploadedSphere sphere = uploaded_sphere(light, origin);
    for (int a = 0; a < 3; ++a) values[a * stride + i] = sphere.place[a];
    values[3 * stride + i] = sphere.radius;
    for (int a = 0; a < 3; ++a) values[(4 + a) * stride + i] = float(light.direction[a]);
    // Rounding of the cosine is given to the cone.
    values[7 * stride + i] = light.cos_outer >= 0 ? float(std::max(0.0, light.cos_outer - 1e-6)) : 2.0f;
  }
  return values;
}

}  // namespace lightgrid
