// Which lights a voxel light buffer gives to which pixel, for the oracle: not part of a frame.
#pragma once

#include "passes/build_voxels.h"

namespace lightgrid {

// The lights of any of the eight samples around each pixel, where `read` says that samples lie. depth: what
// the frame shaded from; null: the depth image.
ListedLights list_voxels(Work& work, const Seen& seen, const ReadVoxels& read, const DepthBuffer& depth);

}  // namespace lightgrid
