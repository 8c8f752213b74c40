// Meshes cut into clusters of neighbouring triangles, so that what the view cannot see is not drawn.
#pragma once

#include <vector>

#include "renderer/gpu_scene.h"

namespace lightgrid {

// Appends the mesh's indices to `indices`, cluster by cluster (meshoptimizer's meshlets), and returns the clusters.
// keep_order: one cluster with the triangles as they are, for blended meshes, where order decides what lies over what.
std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order, std::vector<uint32_t>& indices);

}  // namespace lightgrid
