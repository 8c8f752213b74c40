// Forward shading of opaque surfaces.
#pragma once

#include "passes/common/light_source.h"

namespace lightgrid {

// Shades opaque surfaces with each pixel's lights, at the prepass' depth.
ShadedImage shade_forward(Work& work, const Seen& seen, const DrawList& surfaces, const LightSource& lights);

}  // namespace lightgrid
