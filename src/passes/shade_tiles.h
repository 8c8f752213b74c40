// The light pass of tiled deferred shading, in OpenCL.
#pragma once

#include "passes/gbuffer.h"

namespace lightgrid {

// Adds the lights of the grid's lists, which are in the view's storage of opaque surfaces, to what the geometry buffer's image shows. Where blended surfaces follow, OpenGL gets
// the image back; else it stays where OpenCL left it.
ShadedImage shade_tiles(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth, const LightGrid& grid);

}  // namespace lightgrid
