#include "passes/frame/clusters.h"

#include <meshoptimizer.h>

#include <algorithm>

namespace lightgrid {
namespace {

// Large enough that a draw's cost is its triangles, small enough that a cluster is mostly in view or out of it.
constexpr uint32_t triangles_per_cluster = 128;

}  // namespace

std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order, std::vector<uint32_t>& indices) {
  std::vector<uint32_t> ordered = mesh.indices;
  if (!keep_order && ordered.size() > 3) {
    meshopt_optimizeVertexCache(ordered.data(), ordered.data(), ordered.size(), mesh.positions.size());
  }
  std::vector<TriangleCluster> clusters;
  for (size_t at = 0; at < ordered.size(); at += 3 * triangles_per_cluster) {
    TriangleCluster& cluster = clusters.emplace_back();
    cluster.first_index = uint32_t(indices.size() + at);
    cluster.index_count = uint32_t(std::min<size_t>(3 * triangles_per_cluster, ordered.size() - at));
    for (size_t i = at; i < at + cluster.index_count; ++i) cluster.bounds.add(mesh.positions[ordered[i]]);
  }
  indices.insert(indices.end(), ordered.begin(), ordered.end());
  return clusters;
}

}  // namespace lightgrid
