// Depth of opaque and masked surfaces, before anything is shaded.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

DepthImage depth_prepass(Work& work, const Seen& seen);

}  // namespace lightgrid
