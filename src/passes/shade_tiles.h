// The light pass of tiled deferred shading, in OpenCL.
#pragma once

#include "passes/common/gbuffer.h"

namespace lightgrid {

// Adds the lights of the grid's lists (in the view's storage of opaque surfaces) to the geometry buffer's
// image. If blended surfaces follow, the image is copied back to OpenGL; else it stays in OpenCL's buffer.
ShadedImage shade_tiles(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth,
                        const LightGrid& grid);

// The same from OpenCL's memory; the image stays there.
ShadedImage shade_tiles(RenderView& v, const GBufferInCl& gbuffer, const DepthBuffer& depth,
                        const LightGrid& grid);

}  // namespace lightgrid
