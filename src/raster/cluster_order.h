// An order of a mesh's triangles in which those that lie together and face the same way follow one another.
#pragma once

#include <vector>

#include "raster/rasterizer.h"

namespace lightgrid {

// Numbers of all triangles of the mesh, each once.
std::vector<uint32_t> cluster_order(const RasterMesh& mesh);

}  // namespace lightgrid
