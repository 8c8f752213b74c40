// The scene's lights in view space, in double: used directly by the oracle, and rounded once by the renderer.
#pragma once

#include <vector>

#include "scene/camera.h"
#include "scene/effect_terms.h"
#include "scene/light_ranges.h"
#include "scene/scene.h"

namespace lightgrid {

// KHR_lights_punctual divides by max(0.001, cos(inner) - cos(outer)). Equal angles are a hard edge: its
// quotient is below any rounding of a cosine, so that the same formula is a step, and the square of its
// inverse is a float.
constexpr double softest_edge = 0.001, hard_edge = 0x1p-40;

// The cosine of a cone's half-angle. For the float next to pi/2, which is above it: 0, as for 90 degrees. For
// the float next to pi: -1.
double cone_cosine(float half_angle_rad);

struct ViewLight {
  LightType type = LightType::point;
  glm::dvec3 position{0};           // view space, metres
  glm::dvec3 direction{0, 0, -1};   // view space, unit
  glm::dvec3 radiant_intensity{1};  // colour times intensity: candela, or lux for directional
  double radius_m = std::numeric_limits<double>::infinity();
  double cos_inner = 1, cos_outer = 0;  // half-angles of the cone; cos_inner - cos_outer is at least
                                        // softest_edge or, of a hard edge, hard_edge
  RangeWindow window = RangeWindow::khr;
  double min_falloff = 0;  // 1 / m^2: scene/light_ranges.h
  uint32_t mask = full_mask;
  double max_falloff =
      0;  // 1 / m^2: of a virtual light, whose 1 / distance^2 is at most this; 0: no such light
  // The shares that effects let through, in view space, and their bounds.
  ReachTerms reach{};
  LightShare share{};
  std::shared_ptr<const LitTerm> lit{};  // of the effect that computes the light; null: a point's formula
};

// Radiant intensity in the direction in which effects let through most: the brightness of a light for code
// that has no surface.
inline glm::dvec3 largest_intensity(const ViewLight& light) {
  return light.radiant_intensity * light.share.largest;
}

// The integral of intensity / distance^2 over the range's ball, up to a factor.
inline double influence_of(const ViewLight& light) {
  const glm::dvec3 intensity = largest_intensity(light);
  return (intensity.r + intensity.g + intensity.b) * light.radius_m;
}

// In the scene's order. Positions are subtracted from the eye in double, so that a scene and a camera moved
// together by an exact amount give the same bits.
std::vector<ViewLight> lights_in_view(const Scene& scene, const View& view, const LightRanges& ranges = {});
// The lights at `indices` alone.
std::vector<ViewLight> lights_in_view(const Scene& scene, const View& view, const LightRanges& ranges,
                                      const std::vector<int>& indices);

// The space that a light of any kind can reach: a ball, or the part of it in a cone. Culling, light volumes
// and all else that must find a light's surfaces start from it.
struct LightBounds {
  glm::dvec3 position{0};                                     // in the light's space
  double radius_m = std::numeric_limits<double>::infinity();  // 0 or less: it reaches nothing
  glm::dvec3 direction{0, 0, -1};                             // the cone's axis, unit
  double cos_outer = -1;                                      // the cone's half-angle; -1: the complete ball

  bool has_cone() const { return cos_outer > -1; }
  // Shading rounds the cosine, by less than 10^-6. pi without a cone.
  double widened_angle_rad() const;
};

// World space. The range is that of range_of.
LightBounds bounds_of(const Light& light, double range_m);
// View space.
LightBounds bounds_of(const ViewLight& light);

}  // namespace lightgrid
