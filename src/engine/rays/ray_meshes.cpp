#include "rays/ray_meshes.h"

#include <algorithm>

#include "base/error.h"

namespace lightgrid {
namespace {

constexpr uint64_t max_mesh_triangles = 0x7fffffffu;  // the top bit of a number is RAY_MASKED

bool all_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

std::vector<RayMeshData> ray_meshes(std::span<const RayMesh> meshes) {
  std::vector<RayMeshData> made;
  size_t indices = 0, vertices = 0;
  for (size_t m = 0; m < meshes.size(); ++m) {
    const RayMesh& mesh = meshes[m];
    if (mesh.indices.size() % 3 != 0)
      throw input_error("rays: mesh {}: {} indices are no triangles", m, mesh.indices.size());
    RayMeshData& data =
        made.emplace_back(RayMeshData{.first_index = uint32_t(indices), .first_vertex = uint32_t(vertices)});
    indices += mesh.indices.size();
    vertices += mesh.positions.size();
    if (std::max(indices, vertices) > 0xffffffffu)
      throw machine_error("rays: meshes have 2^32 indices or vertices or more");
    for (const uint32_t i : mesh.indices) {
      if (i >= mesh.positions.size())
        throw input_error("rays: mesh {}: index {} is past its {} positions", m, i, mesh.positions.size());
      const glm::dvec3 p(mesh.positions[i]);
      if (!all_finite(p))
        data.finite = false;
      else {
        data.low = glm::min(data.low, p);
        data.high = glm::max(data.high, p);
      }
    }
    data.positions.assign(mesh.positions.begin(), mesh.positions.end());
    data.indices.assign(mesh.indices.begin(), mesh.indices.end());
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
  if (triangles > max_mesh_triangles)
    throw machine_error("rays: instances have {} triangles, 2^31 or more", triangles);
}

RayBounds ray_bounds(std::span<const RayInstance> instances, std::span<const RayMeshData> meshes) {
  RayBounds all{glm::dvec3(HUGE_VAL), glm::dvec3(-HUGE_VAL)};
  for (const RayInstance& instance : instances) {
    const RayMeshData& mesh = meshes[instance.mesh];
    all.finite = all.finite && mesh.finite;
    if (!(mesh.low.x <= mesh.high.x)) continue;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p(corner & 1 ? mesh.high.x : mesh.low.x, corner & 2 ? mesh.high.y : mesh.low.y,
                         corner & 4 ? mesh.high.z : mesh.low.z);
      const glm::dvec3 q(instance.world_from_object * glm::dvec4(p, 1));
      if (!all_finite(q))
        all.finite = false;
      else {
        all.low = glm::min(all.low, q);
        all.high = glm::max(all.high, q);
      }
    }
  }
  if (!(all.low.x <= all.high.x)) all.low = all.high = glm::dvec3(0);
  return all;
}

// A little more than the bounds, which are of other sums than corners are.
static double reach_of(const RayBounds& bounds, const glm::dvec3& origin) {
  const glm::dvec3 far = glm::max(glm::abs(bounds.low - origin), glm::abs(bounds.high - origin));
  return std::max({far.x, far.y, far.z}) * (1 + 0x1p-20);
}

bool all_are_valid(const RayBounds& bounds, const glm::dvec3& origin) {
  return bounds.finite && reach_of(bounds, origin) <= max_ray_extent;
}

}  // namespace lightgrid
