// The prepass of light_prepass: depth and normals.
#pragma once

#include "passes/common/light_buffer.h"

namespace lightgrid {

// Of opaque and masked surfaces, in one pass over the geometry, in the format of the setting normals. Of
// surfaces with equal depth the last one's normal, as the material pass shades it.
NormalImage fill_normals(Work& work, const Seen& seen);

}  // namespace lightgrid
