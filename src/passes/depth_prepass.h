// Depth of opaque and masked surfaces, before anything is shaded.
#pragma once

#include "passes/common/frame.h"
#include "passes/common/light_buffer.h"

namespace lightgrid {

DepthImage depth_prepass(Work& work);

// Of opaque and masked surfaces, in one pass over the geometry, in the format of the setting normals. Of
// surfaces with equal depth the last one's normal, as the material pass shades it.
NormalImage fill_normals(Work& work);

}  // namespace lightgrid
