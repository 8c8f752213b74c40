// Meshes cut into clusters of neighbouring triangles, so that invisible ones are not drawn.
#pragma once

#include <span>
#include <vector>

#include "renderer/gl_scene.h"

namespace lightgrid {

// Appends the mesh's indices to `indices`, cluster by cluster (meshoptimizer's meshlets), and returns the
// clusters. keep_order: one cluster with the triangles in the given order, for blended meshes, where the
// order is visible.
std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order,
                                             std::vector<uint32_t>& indices);

// Updates bounds and cones of the same clusters after vertices moved. `indices`: all that append_clusters
// appended.
void refresh_clusters(const Mesh& mesh, std::span<const uint32_t> indices,
                      std::vector<TriangleCluster>& clusters);

}  // namespace lightgrid
