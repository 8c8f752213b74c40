// The finished image on the host.
#pragma once

#include "base/image.h"
#include "passes/common/frame.h"

namespace lightgrid {

// Copies the image to the host; `image` keeps its memory from frame to frame.
void read_back(RenderView& v, const ShadedImage& shaded, Image& image);

}  // namespace lightgrid
