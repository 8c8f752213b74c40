// A scene's triangles as the kernels read them, made on the host.
#pragma once

#include <array>
#include <vector>

#include "rays/ray_scene.h"
#include "rays/ray_tree.h"

namespace lightgrid {

struct RayMeshData {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  uint32_t first_index = 0, first_vertex = 0;  // in arrays of all meshes
  bool finite = true;                          // all vertices in use
  glm::dvec3 low{HUGE_VAL}, high{-HUGE_VAL};   // of those that are finite
  uint32_t triangles() const { return uint32_t(indices.size() / 3); }
};

struct RayArrays {
  std::vector<RayNode> nodes;
  std::vector<RayTriangle> triangles;  // those of leaves in the tree's order, then the others
  std::vector<uint32_t> places;        // a triangle's number to its place in `triangles`
  // As kernels/rays/ray_masks.h, a triangle in the tree's order; empty without an alpha material.
  std::vector<std::array<uint32_t, 4>> masks;
  uint32_t invalid = 0;
};

// Both throw Error as RayScene has it.
std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes);
void check_ray_instances(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

// Of all instances' boxes; of none, 0.
struct RayBounds {
  glm::dvec3 low, high;
  bool finite = true;  // every corner is
};
RayBounds ray_bounds(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

// A power of two that no coordinate relative to the origin exceeds; at most the greatest that is allowed.
float ray_extent(const RayBounds& bounds, const glm::dvec3& origin);
// Whether every corner is certainly finite and within the greatest extent.
bool all_are_valid(const RayBounds& bounds, const glm::dvec3& origin);

RayMoved ray_placement(const RayInstance& instance, const RayMeshData& mesh, const glm::dvec3& origin,
                       uint32_t first_triangle);

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin);

}  // namespace lightgrid
