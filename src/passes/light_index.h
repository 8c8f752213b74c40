// Light volumes drawn into images of light indices (docs/techniques/lidr.md).
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

// The lights in the pixel's light indices. Draws light volumes into light index images, at the prepass'
// depth. Throws Error(input) if no layout fits the settings, and Error(machine) if this machine's blending
// would change an index. numbered: as Surfaces has it.
LightSource light_index(Work& work, Cached<LightIndexOrder>& cache, Cached<LightVolumes>& volume_cache,
                        Cached<IndexShadows>& shadow_cache, bool numbered);

// Where the plan's own_shadows is set, puts the frame's shadows and their figures into it.
void tell_index_shadows(Work& work, Cached<IndexShadows>& shadow_cache, Cached<LightVolumes>& volume_cache,
                        Frame& frame);

}  // namespace lightgrid
