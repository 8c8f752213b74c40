#include "renderer/drawing/draw_list.h"

#include <meshoptimizer.h>

namespace lightgrid {
namespace {

// Large enough that triangles dominate the cost of a draw, small enough that most clusters are either in view
// or outside.
constexpr size_t max_vertices = 128, max_triangles = 128;
// Weight by which meshlets prefer triangles that face one way, so that whole clusters are back-facing.
constexpr float cone_weight = 0.5f;

}  // namespace

std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order,
                                             std::vector<uint32_t>& indices) {
  std::vector<TriangleCluster> clusters;
  if (keep_order || mesh.indices.size() <= 3 * max_triangles) {
    clusters.push_back({uint32_t(indices.size()), uint32_t(mesh.indices.size()), mesh.bounds});
    indices.insert(indices.end(), mesh.indices.begin(), mesh.indices.end());
    return clusters;
  }
  const float* positions = &mesh.positions[0].x;
  const size_t bound = meshopt_buildMeshletsBound(mesh.indices.size(), max_vertices, max_triangles);
  std::vector<meshopt_Meshlet> meshlets(bound);
  std::vector<unsigned> vertices(bound * max_vertices);
  std::vector<unsigned char> corners(bound * max_triangles * 3);
  meshlets.resize(meshopt_buildMeshlets(meshlets.data(), vertices.data(), corners.data(), mesh.indices.data(),
                                        mesh.indices.size(), positions, mesh.positions.size(),
                                        sizeof(glm::vec3), max_vertices, max_triangles, cone_weight));
  for (const meshopt_Meshlet& meshlet : meshlets) {
    TriangleCluster& cluster = clusters.emplace_back();
    cluster.first_index = uint32_t(indices.size());
    cluster.index_count = meshlet.triangle_count * 3;
    const unsigned* vertex = &vertices[meshlet.vertex_offset];
    const unsigned char* corner = &corners[meshlet.triangle_offset];
    for (size_t i = 0; i < cluster.index_count; ++i) indices.push_back(vertex[corner[i]]);
    for (size_t i = 0; i < meshlet.vertex_count; ++i) cluster.bounds.add(mesh.positions[vertex[i]]);
    const meshopt_Bounds b = meshopt_computeMeshletBounds(vertex, corner, meshlet.triangle_count, positions,
                                                          mesh.positions.size(), sizeof(glm::vec3));
    cluster.cone_apex = {b.cone_apex[0], b.cone_apex[1], b.cone_apex[2]};
    cluster.cone_axis = {b.cone_axis[0], b.cone_axis[1], b.cone_axis[2]};
    cluster.cone_cutoff = b.cone_cutoff;
  }
  return clusters;
}

void refresh_clusters(const Mesh& mesh, std::span<const uint32_t> indices,
                      std::vector<TriangleCluster>& clusters) {
  if (clusters.size() == 1) {
    clusters[0].bounds = mesh.bounds;
    clusters[0].cone_cutoff = 2;
    return;
  }
  for (TriangleCluster& cluster : clusters) {
    const auto own = indices.subspan(cluster.first_index - clusters[0].first_index, cluster.index_count);
    cluster.bounds = {};
    for (const uint32_t i : own) cluster.bounds.add(mesh.positions[i]);
    const meshopt_Bounds b = meshopt_computeClusterBounds(own.data(), own.size(), &mesh.positions[0].x,
                                                          mesh.positions.size(), sizeof(glm::vec3));
    cluster.cone_apex = {b.cone_apex[0], b.cone_apex[1], b.cone_apex[2]};
    cluster.cone_axis = {b.cone_axis[0], b.cone_axis[1], b.cone_axis[2]};
    cluster.cone_cutoff = b.cone_cutoff;
  }
}

}  // namespace lightgrid
