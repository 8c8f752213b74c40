// Instances of a view as the resolve kernels read them.
#pragma once

#include <span>

#include "renderer/render_view.h"
#include "shared/surface_records.h"

namespace lightgrid {

// Makes the records of these instances of the scene, in their order. Replaces `records`, whose memory is used
// again.
void set_surface_instances(const RenderView& v, std::span<const int> instances,
                           std::vector<SurfaceInstance>& records);

}  // namespace lightgrid
