// The light lists of the world grid (docs/techniques/world_grid.md).
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

// The lights of the cell of the world around the pixel. Builds the lists if the scene's lights changed since
// they were built, or if the camera has moved too far from them. Views of one scene share them. While passes
// are timed they are built in each frame, so that building has a time.
LightSource build_world_grid(PassContext& work, Cached<ViewOfWorldGrid>& cache);

// The lists that the view's last frame read.
const SharedWorldGrid& built_world_grid(PassContext& work, Cached<ViewOfWorldGrid>& cache);

}  // namespace lightgrid
