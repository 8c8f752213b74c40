// A scene's triangles as the kernels read them, made on the host.
#pragma once

#include <vector>

#include "rays/ray_scene.h"
#include "rays/ray_tree.h"

namespace lightgrid {

struct RayMeshData {
  std::vector<glm::vec3> positions;
  std::vector<uint32_t> indices;
  uint32_t triangles() const { return uint32_t(indices.size() / 3); }
};

struct RayArrays {
  std::vector<RayNode> nodes;
  std::vector<RayTriangle> triangles;  // those of leaves in the tree's order, then the others
  std::vector<uint32_t> places;        // a triangle's number to its place in `triangles`
  float extent = 0;                    // the greatest coordinate
  uint32_t invalid = 0;
};

// Both throw Error(input) as RayScene has it.
std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes);
void check_ray_instances(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

// The centre of the bounds of all instances, each coordinate a float; 0 without a finite corner.
glm::dvec3 ray_origin(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes);

RayArrays ray_arrays(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes,
                     const glm::dvec3& origin);

}  // namespace lightgrid
