#include "scene/ray_origin.h"

#include <cmath>

#include "base/median.h"

namespace lightgrid {
namespace {

constexpr size_t max_points = 1000;    // for each kind
constexpr double farthest_m = 0x1p50;  // parked there, to switch it off

template <typename T, typename Place>
void add_places(std::vector<glm::dvec3>& places, const std::vector<T>& of, const Place& place) {
  const size_t step = of.size() / max_points + 1;
  for (size_t i = 0; i < of.size(); i += step) {
    const glm::dvec3 p = place(of[i]);
    if (glm::length(p) < farthest_m) places.push_back(p);
  }
}

}  // namespace

glm::dvec3 ray_origin(const Scene& scene) {
  constexpr glm::dvec3 nowhere(HUGE_VAL);
  std::vector<glm::dvec3> places;
  add_places(places, scene.lights, [&](const Light& l) { return is_directional(l) ? nowhere : l.position; });
  add_places(places, scene.cameras, [](const Camera& c) { return glm::dvec3(c.world_from_view[3]); });
  if (places.empty()) {
    add_places(places, scene.instances, [&](const Instance& i) {
      const Mesh& mesh = scene.meshes[size_t(i.mesh)];
      return mesh.positions.empty() ? nowhere
                                    : glm::dvec3(i.world_from_object * glm::dvec4(mesh.positions[0], 1));
    });
  }
  return glm::round(median_of(std::span<const glm::dvec3>(places)) / ray_origin_step_m) * ray_origin_step_m;
}

}  // namespace lightgrid
