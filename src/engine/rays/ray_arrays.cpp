#include "rays/ray_arrays.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace lightgrid {
namespace {

constexpr uint32_t triangles_a_task = 4096;

// kernels/rays/refit_triangles.cl has the same arithmetic from here to triangle_of.
glm::dvec3 placed(const RayMoved& m, const glm::vec3& v) {
  glm::dvec3 p;
  for (int k = 0; k < 3; ++k)
    p[k] = m.x[k] * double(v.x) + m.y[k] * double(v.y) + m.z[k] * double(v.z) + m.at[k];
  return p;
}

// Divided by its greatest component, so that it stays in float's range for any size of triangle.
glm::dvec3 normal_of(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 n = glm::cross(b - a, c - a);
  const double greatest = std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)});
  return greatest > 0 ? n / greatest : glm::dvec3(0);
}

RayTriangle triangle_of(const glm::vec3 (&corners)[3], uint32_t number) {
  RayTriangle t{.number = number};
  const glm::dvec3 normal = normal_of(corners[0], corners[1], corners[2]);
  for (int k = 0; k < 3; ++k) {
    t.normal[k] = normal[k];
    for (int i = 0; i < 3; ++i) t.corners[3 * i + k] = corners[i][k];
  }
  return t;
}

RayBox box_of(const RayTriangle& t) {
  RayBox box;
  for (int i = 0; i < 3; ++i) box.add({t.corners[3 * i], t.corners[3 * i + 1], t.corners[3 * i + 2]});
  return box;
}

bool fits(const RayTriangle& t) {
  return std::all_of(t.corners, t.corners + 9, [](float v) { return std::abs(v) <= max_ray_extent; });
}

// Calls body(instance's number, first triangle of its mesh, last + 1, number of the first) on all cores.
template <typename Body>
void for_triangles(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                   const Body& body) {
  struct Part {
    size_t instance;
    uint32_t first, end, number;
  };
  std::vector<Part> parts;
  uint32_t number = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    const uint32_t count = meshes[instances[i].mesh].triangles();
    for (uint32_t first = 0; first < count; first += triangles_a_task)
      parts.push_back({i, first, std::min(count, first + triangles_a_task), number + first});
    number += count;
  }
  parallel_for(int(parts.size()), [&](int i) {
    const Part& p = parts[i];
    body(p.instance, p.first, p.end, p.number);
  });
}

}  // namespace

RayMoved ray_placement(const RayInstance& instance, const RayMeshData& mesh, const glm::dvec3& origin,
                       uint32_t first_triangle) {
  RayMoved moved{.first_triangle = first_triangle,
                 .triangles = mesh.triangles(),
                 .first_index = mesh.first_index,
                 .first_vertex = mesh.first_vertex};
  const glm::dmat4& m = instance.world_from_object;
  for (int k = 0; k < 3; ++k) {
    moved.x[k] = m[0][k];
    moved.y[k] = m[1][k];
    moved.z[k] = m[2][k];
    moved.at[k] = m[3][k] - origin[k];
  }
  return moved;
}

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin) {
  size_t count = 0;
  bool masked = false;
  for (const RayInstance& instance : instances) {
    count += meshes[instance.mesh].triangles();
    masked = masked || (instance.casts && instance.alpha_material >= 0);
  }
  std::vector<RayTriangle> by_number(count);
  std::vector<std::array<uint32_t, 4>> masks(masked ? count : 0);
  enum Kind : uint8_t { in_tree, no_caster, invalid };
  std::vector<Kind> kinds(count);
  for_triangles(instances, meshes, [&](size_t i, uint32_t first, uint32_t end, uint32_t number) {
    const RayInstance& instance = instances[i];
    const RayMeshData& mesh = meshes[instance.mesh];
    const RayMoved place = ray_placement(instance, mesh, origin, 0);
    const bool is_masked = instance.casts && instance.alpha_material >= 0;
    for (uint32_t t = first; t < end; ++t, ++number) {
      const uint32_t* at = &mesh.indices[3 * size_t(t)];
      glm::vec3 corners[3];
      for (int k = 0; k < 3; ++k) corners[k] = glm::vec3(placed(place, mesh.positions[at[k]]));
      by_number[number] = triangle_of(corners, is_masked ? number | RAY_MASKED : number);
      kinds[number] = !fits(by_number[number]) ? invalid : instance.casts ? in_tree : no_caster;
      if (!is_masked) continue;
      const uint32_t v = mesh.first_vertex;
      masks[number] = {uint32_t(instance.alpha_material) | (instance.blends ? RAY_BLENDS : 0), v + at[0],
                       v + at[1], v + at[2]};
    }
  });

  RayArrays arrays;
  std::vector<RayBox> boxes;
  std::vector<uint32_t> numbers, others;
  for (uint32_t number = 0; number < count; ++number) {
    arrays.invalid += kinds[number] == invalid;
    if (kinds[number] != in_tree) {
      others.push_back(number);
      continue;
    }
    numbers.push_back(number);
    boxes.push_back(box_of(by_number[number]));
  }
  RayTree tree = ray_tree(boxes);
  arrays.nodes = std::move(tree.nodes);
  arrays.places.resize(count);
  arrays.triangles.reserve(count);
  const auto append = [&](uint32_t number) {
    arrays.places[number] = uint32_t(arrays.triangles.size());
    arrays.triangles.push_back(by_number[number]);
    if (masked) arrays.masks.push_back(masks[number]);
  };
  for (const uint32_t i : tree.order) append(numbers[i]);
  for (const uint32_t number : others) append(number);
  return arrays;
}

}  // namespace lightgrid
