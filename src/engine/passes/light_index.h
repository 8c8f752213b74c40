// Light volumes drawn into images of light indices (docs/techniques/lidr.md).
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

// Puts the frame's light volumes in order. How many passes over the surfaces they take: 1, but with sorted
// packings and lidr-passes as many as hold all lights, or are allowed. Throws Error(input) if no layout fits
// the settings, and Error(machine) if this machine's blending would change an index.
uint32_t order_light_index(PassContext& work, Cached<LightIndexOrder>& cache,
                           Cached<LightVolumes>& volume_cache);

// The lights in the pixel's light indices, of pass number `pass`, after order_light_index. The lists for the
// host are of all passes. Draws light volumes into light index images, at the prepass'
// depth. numbered: as Surfaces has it.
LightSource light_index(PassContext& work, Cached<LightIndexOrder>& cache, Cached<LightVolumes>& volume_cache,
                        Cached<IndexShadows>& shadow_cache, bool numbered, uint32_t pass = 0);

// Where the plan's own_shadows is set, puts the frame's shadows and their figures into it.
void tell_index_shadows(PassContext& work, Cached<IndexShadows>& shadow_cache,
                        Cached<LightVolumes>& volume_cache, Frame& frame);

}  // namespace lightgrid
