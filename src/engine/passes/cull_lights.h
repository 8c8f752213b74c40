// The light grid, and the lights that it gives to a pixel.
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

// The grid of opaque surfaces, or of blended ones, whose cells begin at the near plane. Kept in the view's
// storage.
ViewGrid cull_lights(PassContext& work, LightCuller& culler, SharedGridStorage& storage,
                     const DepthBounds& bounds);
ViewGrid cull_lights_for_blended(PassContext& work, LightCuller& culler, SharedGridStorage& storage,
                                 const DepthBounds& bounds);

// The lights of the pixel's cell.
LightSource from_grid(PassContext& work, const ViewGrid& grid);

}  // namespace lightgrid
