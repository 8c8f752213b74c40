// The light buffer of light_prepass from light volumes, in OpenGL.
#pragma once

#include "passes/common/light_buffer.h"

namespace lightgrid {

// Adds each point and spot light's terms (shared/light_buffer.h), in index order, on the pixels that its
// volume selects by the setting volume-culling. With buffer-bits=8 and 16 the sum is rounded after every
// light.
LightBuffer draw_light_buffer(Work& work, const Seen& seen, Cached<LightVolumes>& cache,
                              const NormalImage& normals);

}  // namespace lightgrid
