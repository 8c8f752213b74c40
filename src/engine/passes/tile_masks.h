// The masks of the surfaces in each tile, next to its depth bounds: a light whose mask shares no bit with any
// of them is then not listed there.
#pragma once

#include "passes/common/surface_numbers.h"
#include "passes/rasterize.h"

namespace lightgrid {

// The masks of triangles, or of surfaces whose numbers surface_numbers_to_cl has passed to OpenCL with the
// depth. In the order of the culler's bounds; kept until the view's next one.
cl::Buffer tile_masks(PassContext& work, Cached<TileMasks>& cache, const CullParams& tiles,
                      const VisibilityBuffer& visible);
cl::Buffer tile_masks(PassContext& work, Cached<TileMasks>& cache, const CullParams& tiles,
                      SharedBuffer& numbers, const DepthBuffer& depth);

}  // namespace lightgrid
