// Depth of opaque and masked surfaces, before anything is shaded.
#pragma once

#include "passes/common/frame.h"
#include "passes/common/light_buffer.h"

namespace lightgrid {

// surface_numbers: an image that gets the numbers of the surfaces' masks (common/surface_numbers.h); 0: none.
// Where surfaces have equal depth it keeps the last one's, as forward shading does.
DepthImage depth_prepass(PassContext& work, GLuint surface_numbers = 0);

// The depth of pixels' centres for read-outs, in a frame of several samples per pixel, in its format and with
// its mask in the stencil. With one sample nothing, as the frame's own depth is that.
GlTexture depth_of_centres(PassContext& work);

// The same image, cleared: for a technique that finds depth as it shades.
DepthImage no_depth_yet(PassContext& work);

// Draws normals with the depth, in one pass over the geometry, in the format of the setting normals. Where
// surfaces have equal depth it keeps the last one's normal, as the material pass shades it.
NormalImage fill_normals(PassContext& work);

}  // namespace lightgrid
