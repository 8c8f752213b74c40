// Passes that add lights one by one, each on the pixels that its volume selects by the setting volume-culling
// (docs/techniques/deferred.md).
#pragma once

#include "passes/common/gbuffer.h"
#include "passes/common/light_buffer.h"

namespace lightgrid {

// Adds each point and spot light, in index order, to `gbuffer.image`, on the pixels that its volume selects
// by the setting volume-culling (docs/techniques/deferred.md).
void shade_light_volumes(PassContext& work, Cached<LightVolumes>& cache, const GBuffer& gbuffer);

// Adds all point and spot lights to `gbuffer.image` in one pass over the screen, without culling.
void shade_full_screen(PassContext& work, const GBuffer& gbuffer);

// The (pixel, light) pairs for which the last frame ran the light shader.
HostLists listed_of_light_volumes(PassContext& work, Cached<LightVolumes>& cache);

// Adds each point and spot light's terms (shared/light_buffer.h), in index order, on the pixels that its
// volume selects by the setting volume-culling. With buffer-bits=8 and 16 the sum is rounded after every
// light.
LightBuffer draw_light_buffer(PassContext& work, Cached<LightVolumes>& cache, const NormalImage& normals);

}  // namespace lightgrid
