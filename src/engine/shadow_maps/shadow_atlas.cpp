#include "shadow_maps/shadow_atlas.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lightgrid {
namespace {

using glm::dvec3;

constexpr double widest_face_rad = 75 * std::numbers::pi / 180;  // half its angle
constexpr double widening = 1e-3;  // relative, for a spot's tangent: shading rounds the cone's cosine

double range_or(const Light& light, double far_m) {
  return std::isfinite(light.radius_m) ? double(light.radius_m) : far_m;
}

bool has_one_face(const Light& light) { return has_cone(light) && light.outer_cone_rad <= widest_face_rad; }

size_t faces_in(const Light& light, const ShadowMapOptions& options) {
  return is_directional(light) ? size_t(options.cascades) : has_one_face(light) ? 1 : 6;
}

double farthest_m(const WorldBox& box, const dvec3& point) {
  return glm::length(glm::max(glm::abs(box.min - point), glm::abs(box.max - point)));
}

// The share of the view that the sphere of the light's range covers; 1 from inside.
double share_of_screen(const Light& light, const View& view, double far_m) {
  const double range = range_or(light, far_m);
  const double away = view.orthographic ? 1 : glm::length(light.position - view.eye);
  const double radius = view.orthographic ? range
                        : away > range    ? range / std::sqrt(away * away - range * range)
                                          : HUGE_VAL;
  const double scale = std::abs(view.clip_from_view[0][0] * view.clip_from_view[1][1]) / 4;
  return std::min(1.0, std::numbers::pi * radius * radius * scale);
}

int size_of(double share, double largest, const ShadowMapOptions& options) {
  const double root = std::sqrt(share / largest);
  const double power = std::round(std::log2(std::max(double(options.size) * root, 1.0)));
  return std::clamp(1 << int(power), min_shadow_size, std::max(options.size, min_shadow_size));
}

std::vector<ShadowFace> faces_of(const Light& light, int size, const ShadowMapOptions& options) {
  if (has_one_face(light)) {
    const double tangent = std::tan(double(light.outer_cone_rad)) * (1 + widening);
    return {shadow_face::towards(glm::normalize(dvec3(light.direction)), tangent, size, options)};
  }
  std::vector<ShadowFace> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      dvec3 ahead(0);
      ahead[axis] = sign;
      faces.push_back(shadow_face::towards(ahead, 1, size, options));
    }
  }
  return faces;
}

}  // namespace

namespace shadow_face {

void set(float (&to)[3], const dvec3& v) {
  for (int k = 0; k < 3; ++k) to[k] = float(v[k]);
}

ShadowFace towards(const dvec3& ahead, double extent, int size, const ShadowMapOptions& options) {
  const dvec3 aside = std::abs(ahead.y) > 0.9 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
  const dvec3 right = glm::normalize(glm::cross(ahead, aside));
  const int border = options.taps / 2;
  ShadowFace face{};
  set(face.right, right);
  set(face.up, glm::cross(right, ahead));
  set(face.ahead, ahead);
  face.extent = float(extent * size / (size - 2 * border));
  face.size = uint(size);
  return face;
}

}  // namespace shadow_face

ShadowAtlas plan_shadow_atlas(std::span<const Light> lights, const View& view, const dvec3& origin,
                              const WorldBox& box, const ShadowMapOptions& options) {
  const size_t texel_bytes = options.bits == 16 ? 2 : 4;
  const double far_m = glm::length(box.max - box.min);
  std::vector<double> shares;
  for (const Light& light : lights)
    shares.push_back(is_directional(light) ? 1 : share_of_screen(light, view, far_m));
  const double largest = shares.empty() ? 0 : *std::ranges::max_element(shares);
  std::vector<int> sizes;
  for (const double share : shares) sizes.push_back(size_of(share, largest, options));
  const auto bytes = [&] {
    size_t sum = 0;
    for (size_t i = 0; i < lights.size(); ++i)
      sum += size_t(sizes[i]) * size_t(sizes[i]) * faces_in(lights[i], options) * texel_bytes;
    return sum;
  };
  ShadowAtlas atlas;
  while (bytes() > options.max_bytes &&
         std::ranges::any_of(sizes, [](int s) { return s > min_shadow_size; })) {
    for (int& size : sizes) size = std::max(size / 2, min_shadow_size);
    ++atlas.halvings;
  }
  for (size_t i = 0; i < lights.size(); ++i) {
    const Light& light = lights[i];
    const uint32_t first = uint32_t(atlas.faces.size());
    std::vector<ShadowFace> faces = is_directional(light)
                                        ? cascades_of(light, view, origin, box, sizes[i], options)
                                        : faces_of(light, sizes[i], options);
    for (ShadowFace& face : faces) {
      if (!is_directional(light)) {
        shadow_face::set(face.from, light.position - origin);
        face.range_m = float(range_or(light, farthest_m(box, light.position)));
      }
      face.first = uint(atlas.texels);
      atlas.texels += size_t(face.size) * face.size;
      atlas.faces.push_back(face);
    }
    atlas.lights.push_back({first, uint32_t(faces.size())});
  }
  atlas.bytes = atlas.texels * texel_bytes;
  return atlas;
}

}  // namespace lightgrid
