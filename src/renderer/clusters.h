// Meshes cut into clusters of neighbouring triangles, so that what the view cannot see is not drawn.
#pragma once

#include <span>
#include <vector>

#include "renderer/gpu_scene.h"

namespace lightgrid {

// Appends the mesh's indices to `indices`, cluster by cluster (meshoptimizer's meshlets), and returns the clusters.
// keep_order: one cluster with the triangles as they are, for blended meshes, where order decides what lies over what.
std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order, std::vector<uint32_t>& indices);

// Bounds and cones of the same clusters after the mesh's vertices moved. `indices`: all that append_clusters appended for it.
void refresh_clusters(const Mesh& mesh, std::span<const uint32_t> indices, std::vector<TriangleCluster>& clusters);

}  // namespace lightgrid
