// Instances of a view as the resolve kernels read them.
#pragma once

#include <span>

#include "renderer/render_view.h"
#include "shared/surface_records.h"

namespace lightgrid {

// Of these instances of the scene, in their order.
std::vector<SurfaceInstance> surface_instances(const RenderView& v, std::span<const int> instances);

}  // namespace lightgrid
