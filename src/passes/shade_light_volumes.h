// Passes that add lights one by one to the image of a geometry buffer.
#pragma once

#include "passes/common/gbuffer.h"

namespace lightgrid {

// Adds each point and spot light, in index order, to `gbuffer.image`, on the pixels that its volume selects
// by the setting volume-culling (docs/techniques/deferred.md).
void shade_light_volumes(Work& work, const Seen& seen, Cached<LightVolumes>& cache, const GBuffer& gbuffer);

// The (pixel, light) pairs for which the last frame ran the light shader.
HostLists listed_of_light_volumes(Work& work, const Seen& seen, Cached<LightVolumes>& cache);

}  // namespace lightgrid
