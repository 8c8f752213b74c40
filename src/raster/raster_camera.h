// A camera in the numbers of the kernels.
#pragma once

#include <vector>

#include "raster/raster_view.h"
#include "shared/raster_params.h"

namespace lightgrid {

// Throws Error(input) as RasterView::set_camera says.
void check_raster_camera(const RasterCamera& camera);

// All but what depends on the scene and on room.
RasterParams raster_params(const RasterCamera& camera);

RasterFrameInstance raster_frame_instance(const RasterCamera& camera, const glm::dmat4& world_from_object,
                                          bool two_sided);

}  // namespace lightgrid
