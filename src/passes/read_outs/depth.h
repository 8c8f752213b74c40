// The depth image of a frame on the host: not part of any technique's frame.
#pragma once

#include <vector>

#include "passes/common/frame.h"

namespace lightgrid {

// The depth image of the last frame: width * height, row 0 at the bottom, 0 for background.
std::vector<float> read_depth(Work& work, const Seen& seen);

}  // namespace lightgrid
