// The mean of a pixel's samples, in linear light.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// The image itself where it has one sample a pixel.
ShadedImage resolve_samples(Work& work, const ShadedImage& image);

}  // namespace lightgrid
