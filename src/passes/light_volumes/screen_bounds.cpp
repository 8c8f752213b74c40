#include "passes/light_volumes/screen_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lightgrid {
namespace {

// As in light_volumes.cpp: float rounding under 1e-5 of the distances, and 1/256 of the radius.
double reach(const LightBounds& light) {
  const glm::dvec3 p = glm::abs(light.position);
  return light.radius_m * (1 + 1.0 / 256) + 1e-5 * (p.x + p.y + p.z + light.radius_m);
}

// The least slope, coordinate / distance, of what is in front of the eye of the circle of radius r about (c,
// d): its tangent's, a root of (d^2 - r^2) s^2 - 2 c d s + c^2 - r^2, written so that nothing cancels.
double least_slope(double c, double d, double r) {
  constexpr double none = -std::numeric_limits<double>::infinity();
  const double squared = c * c + d * d - r * r;
  if (squared <= 0) return none;  // the eye is in the circle
  const double root = r * std::sqrt(squared);
  if (c <= 0) return d > r ? (c * d - root) / ((d - r) * (d + r)) : none;
  return c * d + root > 0 ? (c - r) * (c + r) / (c * d + root) : none;
}

// Pixels between slopes (orthographic: coordinates), plus one on each side.
glm::ivec2 pixels_between(const glm::dvec2& slopes, double clip_scale, double clip_offset, int size) {
  const glm::dvec2 ndc = slopes * clip_scale + clip_offset;
  const glm::dvec2 pixels = (ndc * 0.5 + 0.5) * double(size);
  return glm::ivec2(
      glm::clamp(glm::dvec2(std::floor(pixels.x) - 1, std::ceil(pixels.y) + 1), 0.0, double(size)));
}

void cut_to_tangents(const View& view, const LightBounds& light, ScreenBounds& bounds) {
  const double r = reach(light), d = -light.position.z;
  const glm::dmat4& clip = view.clip_from_view;
  const int size[2] = {view.width, view.height};
  for (int axis = 0; axis < 2; ++axis) {
    const double c = light.position[axis];
    const glm::dvec2 slopes = view.orthographic ? glm::dvec2(c - r, c + r)
                                                : glm::dvec2(least_slope(c, d, r), -least_slope(-c, d, r));
    const double offset = view.orthographic ? clip[3][axis] : -clip[2][axis];
    const glm::ivec2 between = pixels_between(slopes, clip[axis][axis], offset, size[axis]);
    bounds.first[axis] = std::max(bounds.first[axis], between.x);
    bounds.end[axis] = std::max(std::min(bounds.end[axis], between.y), bounds.first[axis]);
  }
}

// Reversed depth at a distance along the view axis.
double depth_at(const View& view, double distance) {
  if (!view.orthographic && distance <= view.near_m) return 1;
  const glm::dvec4 clip = view.clip_from_view * glm::dvec4(0, 0, -distance, 1);
  return std::clamp(clip.z / clip.w, 0.0, 1.0);
}

}  // namespace

ScreenBounds screen_bounds(const View& view, const LightVolume& volume) {
  const LightBounds& light = volume.bounds;
  ScreenBounds bounds{volume.first, volume.end};
  if (!(reach(light) < 1e15)) return bounds;
  cut_to_tangents(view, light, bounds);
  const double nearest = std::max(-light.position.z - reach(light), -volume.center.z - volume.radius);
  const double farthest = std::min(-light.position.z + reach(light), -volume.center.z + volume.radius);
  // Two more float steps for the rounding here.
  bounds.depth.x = float(depth_at(view, farthest)) * (1 - 0x1p-22f);
  bounds.depth.y = float(depth_at(view, nearest)) * (1 + 0x1p-22f);
  return bounds;
}

}  // namespace lightgrid
