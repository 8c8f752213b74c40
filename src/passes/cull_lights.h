// The light grid, in OpenCL, and for OpenGL.
#pragma once

#include "passes/common/frame.h"

namespace lightgrid {

// The grid of opaque surfaces, or of blended ones, whose cells begin at the near plane. Kept in the view's
// storage.
LightGrid cull_lights(RenderView& v, const DepthBounds& bounds);
LightGrid cull_lights_for_blended(RenderView& v, const DepthBounds& bounds);

// Hands a grid to OpenGL.
GridTextures grid_to_gl(RenderView& v, const LightGrid& grid, SharedGridStorage& storage);

}  // namespace lightgrid
