#include "passes/shadows/caster_volumes.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include "base/parallel.h"
#include "plan/instance_boxes.h"

namespace lightgrid {
namespace {

using glm::dvec3;

// Edges between places, however many vertices lie there.
struct MeshEdges {
  std::vector<std::array<uint32_t, 2>> ends;  // 3 triangle + corner, of any triangle that has the edge
  std::vector<uint32_t> of_triangle;          // three each: 2 edge, 1 more if it runs from its second end
};

struct PlaceHash {
  size_t operator()(const glm::vec3& p) const {
    const auto bits = [](float f) { return std::hash<float>()(f); };
    return bits(p.x) ^ bits(p.y) * 0x9e3779b97f4a7c15 ^ bits(p.z) * 0xc2b2ae3d27d4eb4f;
  }
};

MeshEdges edges_of(const Mesh& mesh) {
  std::unordered_map<glm::vec3, uint32_t, PlaceHash> place_of;
  std::vector<uint32_t> places;
  for (const uint32_t vertex : mesh.indices)
    places.push_back(place_of.try_emplace(mesh.positions[vertex], uint32_t(place_of.size())).first->second);
  MeshEdges edges;
  std::unordered_map<uint64_t, uint32_t> edge_of;
  for (uint32_t corner = 0; corner < places.size(); ++corner) {
    const uint32_t next = corner % 3 == 2 ? corner - 2 : corner + 1;
    const uint32_t a = places[corner], b = places[next];
    const auto [found, added] =
        edge_of.try_emplace(uint64_t(std::min(a, b)) << 32 | std::max(a, b), uint32_t(edges.ends.size()));
    if (added) edges.ends.push_back(a < b ? std::array{corner, next} : std::array{next, corner});
    edges.of_triangle.push_back(2 * found->second + (a > b));
  }
  return edges;
}

// An instance that casts, in world space.
struct Caster {
  const MeshEdges* edges;
  uint32_t first_triangle;
  std::vector<dvec3> corners;     // three a triangle
  std::vector<glm::dvec4> balls;  // around each triangle: its centre and radius
  dvec3 low{HUGE_VAL}, high{-HUGE_VAL};
};

Caster caster_of(const Mesh& mesh, const MeshEdges& edges, const glm::dmat4& world_from_object,
                 uint32_t first) {
  Caster caster{&edges, first, {}, {}};
  for (const uint32_t vertex : mesh.indices) {
    const dvec3 p(world_from_object * glm::dvec4(mesh.positions[vertex], 1));
    caster.corners.push_back(p);
    caster.low = glm::min(caster.low, p);
    caster.high = glm::max(caster.high, p);
  }
  for (size_t i = 0; i < caster.corners.size(); i += 3) {
    const dvec3 centre = (caster.corners[i] + caster.corners[i + 1] + caster.corners[i + 2]) / 3.0;
    double radius = 0;
    for (size_t k = i; k < i + 3; ++k) radius = std::max(radius, glm::length(caster.corners[k] - centre));
    caster.balls.emplace_back(centre, radius);
  }
  return caster;
}

bool in_range(const CastingLight& light, const Caster& caster) {
  return glm::length(light.position - glm::clamp(light.position, caster.low, caster.high)) <= light.range_m;
}

// Adds the caster's prisms.
void add_prisms(const CastingLight& light, const Caster& caster, std::vector<uint32_t>& indices) {
  const auto near = [&](uint32_t corner) { return 2 * (3 * caster.first_triangle + corner); };
  const auto far = [&](uint32_t corner) { return near(corner) + 1; };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) { indices.insert(indices.end(), {a, b, c}); };
  std::vector<int16_t> sides(caster.edges->ends.size(), 0);  // from the first end to the second
  std::vector<uint32_t> touched;
  for (uint32_t t = 0; t < caster.balls.size(); ++t) {
    const glm::dvec4& ball = caster.balls[t];
    if (!(glm::length(dvec3(ball) - light.position) <= light.range_m + ball.w)) continue;
    const dvec3 &p = caster.corners[3 * t], &q = caster.corners[3 * t + 1], &r = caster.corners[3 * t + 2];
    const double facing = glm::dot(glm::cross(q - p, r - p), light.position - p);
    if (!(facing > 0 || facing < 0)) continue;  // edge-on, or no area
    // Counter-clockwise as the light sees it.
    const uint32_t a = 3 * t, b = facing > 0 ? a + 1 : a + 2, c = facing > 0 ? a + 2 : a + 1;
    add(near(a), near(b), near(c));
    add(far(c), far(b), far(a));
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t edge = caster.edges->of_triangle[3 * t + k];
      const bool from_first = (edge & 1) == (facing > 0 ? 0u : 1u);
      sides[edge / 2] = int16_t(sides[edge / 2] + (from_first ? 1 : -1));
      touched.push_back(edge / 2);
    }
  }
  for (const uint32_t edge : touched) {
    auto [a, b] = caster.edges->ends[edge];
    if (sides[edge] < 0) std::swap(a, b);
    for (int n = std::abs(sides[edge]); n > 0; --n) {
      add(near(b), near(a), far(a));
      add(near(b), far(a), far(b));
    }
    sides[edge] = 0;  // it may come again
  }
}

}  // namespace

CasterVolumes caster_volumes(const Scene& scene, const RayScene& rays, std::span<const CastingLight> lights) {
  std::map<int, MeshEdges> edges;
  std::vector<Caster> casters;
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene.meshes[size_t(instance.mesh)];
    if (!instance.casts_shadow || is_blended(scene, int(i))) continue;
    const auto [found, added] = edges.try_emplace(instance.mesh);
    if (added) found->second = edges_of(mesh);
    casters.push_back(caster_of(mesh, found->second, instance.world_from_object, rays.first_triangle(i)));
  }
  std::vector<std::vector<uint32_t>> of_light(lights.size());
  parallel_for(int(lights.size()), [&](int i) {
    const CastingLight& light = lights[size_t(i)];
    if (!(light.range_m > 0)) return;
    for (const Caster& caster : casters)
      if (in_range(light, caster)) add_prisms(light, caster, of_light[size_t(i)]);
  });
  CasterVolumes volumes;
  for (const std::vector<uint32_t>& one : of_light) {
    volumes.of_light.push_back({volumes.indices.size(), one.size()});
    volumes.indices.insert(volumes.indices.end(), one.begin(), one.end());
  }
  return volumes;
}

}  // namespace lightgrid
