#include "check/light_cells.h"

#include <algorithm>
#include <cmath>

namespace lightgrid::lab {
namespace {

using glm::dvec3;
using glm::ivec3;

// Edges of cells: in clip space from the left and the bottom, metres from the eye.
struct Edges {
  std::vector<double> x, y, z;
};

// ClusteredLightsNode of three.js (folder examples/jsm/tsl/lighting): the image is rounded up to whole tiles, which
// then divide all of clip space.
Edges edges_of_three(const View& view) {
  constexpr int tile = 32, slices = 24;
  constexpr double default_far_m = 2000;
  Edges edges;
  const int across = (view.width + tile - 1) / tile, up = (view.height + tile - 1) / tile;
  for (int i = 0; i <= across; ++i) edges.x.push_back(2.0 * i / across - 1);
  for (int i = 0; i <= up; ++i) edges.y.push_back(2.0 * i / up - 1);
  const double near_m = std::max(view.near_m, 1e-6);  // an orthographic view may have none
  const double far_m = std::isfinite(view.far_m) ? view.far_m : default_far_m;
  for (int k = 0; k <= slices; ++k) edges.z.push_back(near_m * std::pow(far_m / near_m, double(k) / slices));
  return edges;
}

// Unreal, LightGridInjection.cpp, in centimetres: slice = log2(z B + O) S, with the last one at the furthest
// light. Tiles count from the top.
Edges edges_of_unreal(const View& view, const std::vector<ViewLight>& in_view,
                      const std::vector<int>& lights) {
  constexpr int tile = 64, slices = 32;
  constexpr double cm = 100, scale = 4.05, near_offset = 9.5, min_far = 1000, last_far = 2e6;
  Edges edges;
  const int across = (view.width + tile - 1) / tile, up = (view.height + tile - 1) / tile;
  for (int i = 0; i <= across; ++i) edges.x.push_back(2.0 * tile * i / view.width - 1);
  for (int i = up; i >= 0; --i) edges.y.push_back(1 - 2.0 * tile * i / view.height);
  double furthest = min_far;
  for (const int i : lights) {
    const ViewLight& light = in_view[size_t(i)];
    if (std::isfinite(light.radius_m))
      furthest = std::max(furthest, (light.radius_m - light.position.z) * cm);
  }
  const double n = view.near_m * cm + near_offset, f = furthest + 10;
  const double o = (f - n * std::exp2((slices - 1) / scale)) / (f - n), b = (1 - o) / n;
  for (int k = 0; k <= slices; ++k) edges.z.push_back((std::exp2(k / scale) - o) / b / cm);
  edges.z.front() = 0;
  edges.z.back() = last_far / cm;
  return edges;
}

// The box in view space around a part of the frustum.
LightBox box_of_cell(const View& view, const Edges& edges, const ivec3& cell) {
  const double near_m = edges.z[size_t(cell.z)], far_m = edges.z[size_t(cell.z) + 1];
  LightBox box;
  for (const double depth : {near_m, far_m}) {
    for (int side = 0; side < 2; ++side) {
      const double scale = view.orthographic ? 1 : depth;
      const double x = edges.x[size_t(cell.x + side)] * scale / view.clip_from_view[0][0];
      const double y = edges.y[size_t(cell.y + side)] * scale / view.clip_from_view[1][1];
      box.min = glm::min(box.min, dvec3(x, y, -depth));
      box.max = glm::max(box.max, dvec3(x, y, -depth));
    }
  }
  return box;
}

// Against the plane through the cone's apex that leans towards the box the most (Unreal,
// AabbOutsideInfiniteAcuteConeApprox).
bool outside_cone(const LightBox& box, const ViewLight& light) {
  if (!has_cone(light) || light.cos_outer <= 0) return false;
  const dvec3 away = 0.5 * (box.min + box.max) - light.position;
  const dvec3 across = glm::cross(glm::cross(away, light.direction), light.direction);
  if (glm::length(across) == 0) return false;
  const double tangent = std::sqrt(1 - light.cos_outer * light.cos_outer) / light.cos_outer;
  const dvec3 normal = -tangent * light.direction - glm::normalize(across);
  return glm::dot(away, normal) > glm::dot(0.5 * (box.max - box.min), glm::abs(normal));
}

}  // namespace

LightBox box_of_light(const LightBounds& light) {
  if (!light.has_cone() || !std::isfinite(light.radius_m) || light.cos_outer <= 0)
    return {light.position - light.radius_m, light.position + light.radius_m};
  const double disc_m = light.radius_m * std::sqrt(1 - light.cos_outer * light.cos_outer) / light.cos_outer;
  const dvec3 middle = light.position + light.direction * light.radius_m;
  const dvec3 disc = disc_m * glm::sqrt(glm::max(1.0 - light.direction * light.direction, 0.0));
  return {glm::min(light.position, middle - disc), glm::max(light.position, middle + disc)};
}

bool meets(const LightBox& a, const LightBox& b) {
  return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

bool meets(const LightBox& box, const glm::dvec3& center, double radius) {
  const dvec3 away = center - glm::clamp(center, box.min, box.max);
  return glm::dot(away, away) <= radius * radius;
}

// _getBoundingSphereCenter and _getBoundingSphereRadius of ClusteredLightsNode.
ViewLight as_listed(LimitCells layout, ViewLight light) {
  if (layout != LimitCells::three || !has_cone(light) || !std::isfinite(light.radius_m)) return light;
  const double cosine = std::max<double>(light.cos_outer, 0);
  const bool wide = cosine < std::sqrt(0.5);
  const double along_m = wide ? light.radius_m * cosine : light.radius_m / (2 * cosine);
  light.position += light.direction * along_m;
  light.radius_m = wide ? light.radius_m * std::sqrt(1 - cosine * cosine) : along_m;
  return light;
}

glm::ivec3 each_cell(LimitCells layout, const View& view, const std::vector<ViewLight>& scene_lights,
                     const std::vector<int>& lights, const CellVisit& visit) {
  std::vector<ViewLight> in_view;
  for (const ViewLight& light : scene_lights) in_view.push_back(as_listed(layout, light));
  const Edges edges =
      layout == LimitCells::three ? edges_of_three(view) : edges_of_unreal(view, in_view, lights);
  const ivec3 size(edges.x.size() - 1, edges.y.size() - 1, edges.z.size() - 1);
  std::vector<int> of_slice, of_cell;
  for (int z = 0; z < size.z; ++z) {
    of_slice.clear();
    std::ranges::copy_if(lights, std::back_inserter(of_slice), [&](int i) {
      const ViewLight& light = in_view[size_t(i)];
      return light.radius_m - light.position.z >= edges.z[size_t(z)] &&
             -light.position.z - light.radius_m <= edges.z[size_t(z) + 1];
    });
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const LightBox box = box_of_cell(view, edges, {x, y, z});
        of_cell.clear();
        std::ranges::copy_if(of_slice, std::back_inserter(of_cell), [&](int i) {
          const ViewLight& light = in_view[size_t(i)];
          return meets(box, light.position, light.radius_m) &&
                 (layout == LimitCells::three || !outside_cone(box, light));
        });
        visit({x, y, z}, box, of_cell);
      }
    }
  }
  return size;
}

}  // namespace lightgrid::lab
