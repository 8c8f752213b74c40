// Meshes cut into clusters of neighbouring triangles, so that what the view cannot see is not drawn.
#pragma once

#include <vector>

#include "passes/frame/gpu_scene.h"

namespace lightgrid {

// Appends the mesh's indices to `indices`, reordered for the vertex cache and for little overdraw (meshoptimizer),
// and returns its clusters. Blended meshes keep their order, which decides what lies over what.
std::vector<TriangleCluster> append_clusters(const Mesh& mesh, bool keep_order, std::vector<uint32_t>& indices);

}  // namespace lightgrid
