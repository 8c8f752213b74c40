// The picture as a display shows it, in bytes, where the image is.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// Throws Error(input) with picture=bytes where the settings have no exposure.
void check_picture(const Settings& settings);

// The bytes of srgb_bytes (base/image.h) at the settings' exposure. Those of an image in OpenGL may differ by
// one step where OpenGL does not round divisions correctly.
DisplayedImage tone_map(PassContext& work, Cached<ToneMap>& cache, const ShadedImage& image);

}  // namespace lightgrid
