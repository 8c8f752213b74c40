// The distances of surfaces in each tile.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// Copies the depth image to OpenCL.
DepthBuffer depth_to_cl(PassContext& work, const DepthImage& depth);

// An interval of distances a tile. With depth-bounds=none the buffer is not read.
DepthBounds depth_bounds(PassContext& work, LightCuller& culler, const DepthBuffer& depth);

// The depth bounds on the host, for culling hidden surfaces. Empty with depth-bounds=none.
TileDistances tile_distances(PassContext& work, LightCuller& culler, const DepthBounds& bounds);

// The view's opaque surfaces, without those that every tile hides.
DrawList visible_surfaces(PassContext& work, const TileDistances& distances);

}  // namespace lightgrid
