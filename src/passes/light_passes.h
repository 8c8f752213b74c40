// Lights added one by one to the image of a geometry buffer.
#pragma once

#include "passes/gbuffer.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Adds each point and spot light, in the order of their indices, to `gbuffer.image`: where its volume says
// that it may reach, as the setting volume-culling has it (docs/techniques/deferred.md).
void shade_light_volumes(RenderView& v, const GBuffer& gbuffer);

// The (pixel, light) pairs for which the last frame's passes ran the shader. For the oracle, not part of a
// frame.
ListedLights listed_of_light_volumes(RenderView& v);

}  // namespace lightgrid
