// Meshes and instances on the host: checked, and how far they reach.
#pragma once

#include <cmath>
#include <vector>

#include "rays/ray_scene.h"

namespace lightgrid {

struct RayMeshData {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  uint32_t first_index = 0, first_vertex = 0;  // in arrays of all meshes
  bool finite = true;                          // all vertices in use
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};   // bounds of the finite corners
  uint32_t triangles() const { return uint32_t(indices.size() / 3); }
};

constexpr float max_ray_extent = 0x1p50f;  // metres: products of three coordinates stay finite

// Both throw Error as RayScene has it.
std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes);
void check_ray_instances(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

// The bounds of all instances' boxes; 0 without instances.
struct RayBounds {
  glm::dvec3 low, high;
  bool finite = true;  // every corner is
};
RayBounds ray_bounds(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

// Returns whether every corner is certainly finite and within the greatest extent.
bool all_are_valid(const RayBounds& bounds, const glm::dvec3& origin);

}  // namespace lightgrid
