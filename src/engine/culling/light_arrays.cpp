#include "culling/light_arrays.h"

#include <algorithm>
#include <cmath>

#include "base/median.h"

namespace lightgrid {
namespace {

constexpr float endless = std::numeric_limits<float>::infinity();
constexpr double small_part = 0x1p-8;  // relative to a radius

// A light has a position and a radius; without either it is listed nowhere.
bool is_light(const CullLight& light) {
  return light.radius_m >= 0 && std::isfinite(light.position.x) && std::isfinite(light.position.y) &&
         std::isfinite(light.position.z);
}

// Kernels make the axis a unit vector, in float. An axis whose square under- or overflows has no direction there.
bool has_cone(const CullLight& light) {
  const double length = glm::length(light.direction);
  return light.cos_outer >= 0 && length >= 1e-15 && length <= 1e15;
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

double sum_of(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

// The largest rounding of an uploaded position, metres in view space.
double upload_rounding(const glm::dvec3& offset) {
  return half_ulp * sum_of(offset) * (1 + double(MAX_STRETCH));
}

// Coordinates of actual lights: moving all lights by an exact amount moves the origin by that amount. Lights
// parked far away, to switch them off, are ignored if there are others.
glm::dvec3 median_position(std::span<const CullLight> lights) {
  std::vector<glm::dvec3> near, far;
  for (const CullLight& light : lights) {
    if (is_light(light)) (largest(light.position) < farthest_light ? near : far).push_back(light.position);
  }
  return median_of(std::span<const glm::dvec3>(near.empty() ? far : near));
}

// The difference may overflow; half of it cannot.
glm::dvec3 half_offset(const CullLight& light, const glm::dvec3& origin) {
  return light.position * 0.5 - origin * 0.5;
}

bool is_far(const CullLight& light, const glm::dvec3& origin) {
  return largest(half_offset(light, origin)) >= farthest_light / 2;
}

struct UploadedSphere {
  glm::vec3 position{0};
  float radius = -far_away;  // listed nowhere
};

float radius_rounded_up(double radius) {
  const float value = float(std::min(radius, 3e38));
  return value > 0 ? std::nextafter(value, endless) : 0.0f;
}

// A far light whose sphere does not reach the eye lights only surfaces past farthest_surface, in cells that
// span every distance. Scaling towards the eye keeps the directions in which such a cell sees the light. The
// scaling here is towards the origin; the radius is grown for the distance between eye and origin.
UploadedSphere far_sphere(const CullLight& light, const glm::dvec3& origin, double eye_reach) {
  const glm::dvec3 half = half_offset(light, origin);
  const double size = largest(half);
  if (light.radius_m * 0.5 > size / 4) return {glm::vec3(0), endless};
  return {glm::vec3(half / size * farthest_light),
          radius_rounded_up(light.radius_m * 0.5 / size * farthest_light + 4 * half_ulp * farthest_light +
                            2 * eye_reach)};
}

// The radius is grown by the rounding error of the position.
UploadedSphere uploaded_sphere(const CullLight& light, const glm::dvec3& origin, double eye_reach) {
  if (!is_light(light)) return {};
  if (std::isinf(light.radius_m))
    return {glm::vec3(is_far(light, origin) ? glm::dvec3(0) : light.position - origin), endless};
  if (is_far(light, origin)) return far_sphere(light, origin, eye_reach);
  const glm::dvec3 offset = light.position - origin;
  return {glm::vec3(offset), radius_rounded_up(light.radius_m + upload_rounding(offset))};
}

// The uploaded cosine of the cone: the cone is widened by the cosine's rounding. 2 means that the sphere
// alone decides.
float uploaded_cosine(const CullLight& light, const glm::dvec3& origin) {
  return has_cone(light) && !is_far(light, origin) ? float(std::max(0.0, light.cos_outer - 1e-6)) : 2.0f;
}

}  // namespace

LightOrigin choose_origin(std::span<const CullLight> lights) {
  const glm::dvec3 origin = median_position(lights);
  size_t count = 0, coarse = 0;
  double cone_slack = 0;
  std::vector<double> spot_radii;
  for (const CullLight& light : lights) {
    // A light of radius 0 lights nothing.
    if (!is_light(light) || light.radius_m == 0 || is_far(light, origin)) continue;
    const double rounding = upload_rounding(light.position - origin);
    ++count;
    if (rounding > small_part * light.radius_m) ++coarse;
    if (!has_cone(light)) continue;
    cone_slack = std::max(cone_slack, rounding);
    spot_radii.push_back(light.radius_m);
  }
  if (coarse > count / 64) return {};
  if (!spot_radii.empty() && cone_slack > small_part * median_of(std::move(spot_radii))) return {};
  return {origin, cone_slack};
}

std::vector<float> light_arrays(std::span<const CullLight> lights, const glm::dvec3& origin, double eye_reach,
                                size_t stride) {
  std::vector<float> values(world_arrays * stride);
  std::fill_n(values.begin() + 3 * stride, stride, -far_away);  // padding
  for (size_t i = 0; i < lights.size(); ++i) {
    const CullLight& light = lights[i];
    const UploadedSphere sphere = uploaded_sphere(light, origin, eye_reach);
    for (int a = 0; a < 3; ++a) values[a * stride + i] = sphere.position[a];
    values[3 * stride + i] = sphere.radius;
    for (int a = 0; a < 3; ++a) values[(4 + a) * stride + i] = float(light.direction[a]);
    values[7 * stride + i] = uploaded_cosine(light, origin);
  }
  return values;
}

}  // namespace lightgrid
