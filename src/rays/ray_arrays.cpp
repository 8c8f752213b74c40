#include "rays/ray_arrays.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace lightgrid {
namespace {

constexpr uint64_t most_triangles = 0x7fffffffu;  // kernels compare their numbers as signed ones
constexpr float most_extent = 1e15f;              // metres: products of three stay finite
constexpr uint32_t triangles_a_task = 4096;

// Rows of world_from_object, relative to the origin.
struct Placement {
  glm::dvec3 x, y, z, at;
};

Placement placement_of(const glm::dmat4& m, const glm::dvec3& origin) {
  return {glm::dvec3(m[0]), glm::dvec3(m[1]), glm::dvec3(m[2]), glm::dvec3(m[3]) - origin};
}

glm::dvec3 placed(const Placement& p, const glm::vec3& v) {
  return p.x * double(v.x) + p.y * double(v.y) + p.z * double(v.z) + p.at;
}

bool all_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool fits(const glm::vec3& v) {
  return std::abs(v.x) <= most_extent && std::abs(v.y) <= most_extent && std::abs(v.z) <= most_extent;
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

// Calls body(instance, first triangle of its mesh, last + 1, number of the first) on all cores.
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
    for (uint32_t first = 0; first < count; first += triangles_a_task) {
      const uint32_t end = std::min(count, first + triangles_a_task);
      parts.push_back({i, first, end, number + first});
    }
    number += count;
  }
  parallel_for(int(parts.size()), [&](int i) {
    const Part& p = parts[i];
    body(instances[p.instance], p.first, p.end, p.number);
  });
}

}  // namespace

std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes) {
  std::vector<RayMeshData> made;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const RayMesh& mesh = meshes[m];
    if (mesh.indices.size() % 3 != 0)
      throw input_error("rays: mesh {}: {} indices are no triangles", m, mesh.indices.size());
    const auto largest = std::max_element(mesh.indices.begin(), mesh.indices.end());
    if (largest != mesh.indices.end() && *largest >= mesh.positions.size())
      throw input_error("rays: mesh {}: index {} is past its {} positions", m, *largest,
                        mesh.positions.size());
    made.push_back(
        {{mesh.positions.begin(), mesh.positions.end()}, {mesh.indices.begin(), mesh.indices.end()}});
  }
  return made;
}

void check_ray_instances(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes) {
  uint64_t triangles = 0;
  for (size_t i = 0; i < instances.size(); ++i) {
    const RayInstance& instance = instances[i];
    if (instance.mesh < 0 || size_t(instance.mesh) >= meshes.size())
      throw input_error("rays: instance {} has mesh {} of {}", i, instance.mesh, meshes.size());
    const glm::dmat4& m = instance.world_from_object;
    for (int column = 0; column < 4; ++column) {
      if (!all_finite(glm::dvec3(m[column])) || m[column][3] != (column == 3 ? 1 : 0))
        throw input_error("rays: instance {}: world_from_object is not finite and affine", i);
    }
    triangles += meshes[instance.mesh].triangles();
  }
  if (triangles > most_triangles)
    throw machine_error("rays: instances have {} triangles, 2^31 or more", triangles);
}

glm::dvec3 ray_origin(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes) {
  glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
  for (const RayInstance& instance : instances) {
    const Placement place = placement_of(instance.world_from_object, glm::dvec3(0));
    const RayMeshData& mesh = meshes[instance.mesh];
    for (const uint32_t i : mesh.indices) {
      const glm::dvec3 p = placed(place, mesh.positions[i]);
      if (all_finite(p)) low = glm::min(low, p), high = glm::max(high, p);
    }
  }
  const glm::dvec3 center(glm::vec3(low * 0.5 + high * 0.5));
  return all_finite(center) ? center : glm::dvec3(0);
}

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin) {
  size_t count = 0;
  for (const RayInstance& instance : instances) count += meshes[instance.mesh].triangles();
  std::vector<RayTriangle> by_number(count);
  enum Kind : uint8_t { in_tree, no_caster, invalid };
  std::vector<Kind> kinds(count);
  for_triangles(instances, meshes,
                [&](const RayInstance& instance, uint32_t first, uint32_t end, uint32_t number) {
                  const RayMeshData& mesh = meshes[instance.mesh];
                  const Placement place = placement_of(instance.world_from_object, origin);
                  for (uint32_t t = first; t < end; ++t, ++number) {
                    glm::vec3 corners[3];
                    for (int k = 0; k < 3; ++k)
                      corners[k] = glm::vec3(placed(place, mesh.positions[mesh.indices[3 * t + k]]));
                    by_number[number] = triangle_of(corners, number);
                    const bool valid = fits(corners[0]) && fits(corners[1]) && fits(corners[2]);
                    kinds[number] = !valid ? invalid : instance.casts ? in_tree : no_caster;
                  }
                });

  RayArrays arrays;
  std::vector<RayBox> boxes;
  std::vector<uint32_t> numbers, others;
  RayBox all;
  for (uint32_t number = 0; number < count; ++number) {
    if (kinds[number] == invalid) ++arrays.invalid;
    if (kinds[number] != in_tree) {
      others.push_back(number);
      continue;
    }
    numbers.push_back(number);
    boxes.push_back(box_of(by_number[number]));
    all.add(boxes.back());
  }
  if (!numbers.empty()) {
    const glm::vec3 far = glm::max(glm::abs(all.low), glm::abs(all.high));
    arrays.extent = std::max({far.x, far.y, far.z});
  }
  RayTree tree = ray_tree(boxes);
  arrays.nodes = std::move(tree.nodes);
  arrays.places.resize(count);
  arrays.triangles.reserve(count);
  const auto append = [&](uint32_t number) {
    arrays.places[number] = uint32_t(arrays.triangles.size());
    arrays.triangles.push_back(by_number[number]);
  };
  for (const uint32_t i : tree.order) append(numbers[i]);
  for (const uint32_t number : others) append(number);
  return arrays;
}

}  // namespace lightgrid
