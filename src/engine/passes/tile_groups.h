// The light groups of the surfaces in each tile, beside its depth bounds: a light whose groups none of them
// has is then not listed there.
#pragma once

#include "passes/common/group_numbers.h"
#include "passes/rasterize.h"

namespace lightgrid {

// The groups of triangles, or of numbers of masks that copy_group_numbers has passed to OpenCL with the
// depth. In the order of the culler's bounds; kept until the view's next one.
cl::Buffer tile_groups(Work& work, Cached<TileGroups>& cache, const CullParams& tiles,
                       const VisibilityBuffer& visible);
cl::Buffer tile_groups(Work& work, Cached<TileGroups>& cache, const CullParams& tiles, SharedBuffer& numbers,
                       const DepthBuffer& depth);

}  // namespace lightgrid
