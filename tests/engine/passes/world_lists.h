// Lists of a world grid at points, and points that lights just reach, in double.
#pragma once

#include <algorithm>

#include "renderer/shared_grids.h"
#include "scene/random.h"
#include "support/devices.h"

namespace lightgrid {

struct Lists {
  WorldLayout layout;
  HostWorldGrid lists;
  size_t blocks = 0, entries = 0;
};

inline View view_from(const glm::dvec3& eye, const glm::dvec3& target) {
  return make_view(look_at(eye, target), 64, 48);
}

inline CullLight ball(const glm::dvec3& position, double radius) { return {position, radius}; }

// The lights that a shader adds at a position that it computed in view space.
inline std::vector<uint32_t> list_at(const Lists& grid, const View& view, const glm::vec3& in_view) {
  const glm::uvec2 range = grid.lists.range_at(world_position(in_view, world_view_params(grid.layout, view)));
  std::vector<uint32_t> list(grid.lists.indices.begin() + range.x,
                             grid.lists.indices.begin() + range.x + range.y);
  list.insert(list.end(), grid.lists.everywhere().begin(), grid.lists.everywhere().end());
  std::ranges::sort(list);
  return list;
}

inline glm::vec3 in_view(const View& view, const glm::dvec3& world) {
  return glm::vec3(glm::dmat3(view.view_from_world) * (world - view.eye));
}

inline bool reaches(const CullLight& light, const View& view, const glm::vec3& point) {
  const glm::dvec3 world = glm::transpose(glm::dmat3(view.view_from_world)) * glm::dvec3(point) + view.eye;
  const glm::dvec3 from = world - light.position;
  const double distance = glm::length(from);
  if (!(distance < light.radius_m)) return false;
  return light.cos_outer < 0 || glm::dot(from, light.direction) > distance * light.cos_outer;
}

// A point at the edge of what a light reaches, or next to it.
inline glm::dvec3 at_the_edge(const CullLight& light, Random& random) {
  const glm::dvec3 any = any_direction(random);
  glm::dvec3 direction = any;
  if (light.cos_outer >= 0) {
    const glm::dvec3 across = glm::normalize(any - light.direction * glm::dot(any, light.direction));
    const double angle =
        std::acos(light.cos_outer) * (random.uniform() < 0.5f ? 1 - 1e-7 : double(random.uniform()));
    direction = light.direction * std::cos(angle) + across * std::sin(angle);
  }
  const double inward[] = {1e-9, 1e-7, 1e-6, 1e-4, 0.3};
  return light.position + direction * (light.radius_m * (1 - inward[random.next() % 5]));
}

}  // namespace lightgrid
