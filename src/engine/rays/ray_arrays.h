// A scene's triangles as the kernels read them, made on the host.
#pragma once

#include <array>
#include <vector>

#include "rays/ray_meshes.h"
#include "rays/ray_tree.h"

namespace lightgrid {

struct RayArrays {
  std::vector<RayNode> nodes;
  std::vector<RayTriangle> triangles;  // triangles of leaves in the tree's order, then the others
  std::vector<uint32_t> places;        // a triangle's number to its place in `triangles`
  // As kernels/rays/ray_masks.h, a triangle in the tree's order; empty without an alpha material.
  std::vector<std::array<uint32_t, 4>> masks;
  uint32_t invalid = 0;
};

RayMoved ray_placement(const RayInstance& instance, const RayMeshData& mesh, const glm::dvec3& origin,
                       uint32_t first_triangle);

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin);

}  // namespace lightgrid
