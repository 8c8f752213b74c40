// Surfaces into the geometry buffer.
#pragma once

#include "passes/common/gbuffer.h"

namespace lightgrid {

// Opaque surfaces with their depth, in one pass over the geometry.
GBuffer fill_gbuffer(PassContext& work, BaseLighting base_lighting = BaseLighting::in_image);

// Only these surfaces, at the prepass' depth.
GBuffer fill_gbuffer(PassContext& work, const DrawList& surfaces,
                     BaseLighting base_lighting = BaseLighting::in_image);

}  // namespace lightgrid
