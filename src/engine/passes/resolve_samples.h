// The mean of a pixel's samples, as samples-resolve says.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// The define of shared/average.h; null: in linear light.
const char* average_define(const Settings& settings);

// The image itself where it has one sample a pixel.
ShadedImage resolve_samples(PassContext& work, const ShadedImage& image);

}  // namespace lightgrid
