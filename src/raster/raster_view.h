// A view in the numbers of the kernels.
#pragma once

#include <vector>

#include "raster/rasterizer.h"
#include "shared/raster_params.h"

namespace lightgrid {

// Throws Error(input) as Rasterizer::set_view says.
void check_raster_view(const RasterView& view);

// All but what depends on the scene and on room.
RasterParams raster_params(const RasterView& view);

RasterFrameInstance raster_frame_instance(const RasterView& view, const glm::dmat4& world_from_object,
                                          bool two_sided);

}  // namespace lightgrid
