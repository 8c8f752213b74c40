// The light pass of tiled deferred shading, in OpenCL.
#pragma once

#include "passes/common/gbuffer.h"
#include "passes/common/light_source.h"

namespace lightgrid {

// Adds the lights of the pixel's cell to the geometry buffer's image. Where OpenGL drew that and blends
// surfaces over it, the image is copied back; else it stays in OpenCL's buffer. The surfaces' numbers
// are in OpenCL already (surface_numbers_to_cl).
// Of several samples a pixel the image is their mean; the frame gets their figures.
ShadedImage shade_tiles(PassContext& work, PassCaches& caches, const GBuffer& gbuffer,
                        const DepthBuffer& depth, const LightSource& lights, Frame& frame);

}  // namespace lightgrid
