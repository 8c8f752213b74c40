// Instances of a view as the resolve kernels read them.
#pragma once

#include <span>

#include "renderer/pass_caches.h"
#include "shared/surface_records.h"

namespace lightgrid {

// Of these instances of the scene, in their order. Replaces `records`, whose memory is used again.
void set_surface_instances(const Seen& seen, std::span<const int> instances,
                           std::vector<SurfaceInstance>& records);

}  // namespace lightgrid
