// Light volumes drawn into images of light indices (docs/techniques/lidr.md).
#pragma once

#include "passes/common/frame.h"
#include "scene/listed_lights.h"

namespace lightgrid {

// Draws light volumes into light index images, at the prepass' depth. Throws Error(input) if no layout fits
// the settings, and Error(machine) if this machine's blending would change an index.
LightIndexImages light_index(RenderView& v);
// The lists of the last frame, for the oracle.
ListedLights read_light_index(RenderView& v);

}  // namespace lightgrid
