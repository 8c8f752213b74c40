// The surfaces that shading saw, for the oracle: not part of any technique's frame.
#pragma once

#include "base/image.h"
#include "passes/frame.h"

namespace lightgrid {

struct SurfaceImages {
  Image normal_roughness;      // view-space shading normal; perceptual roughness
  Image base_color_metallic;
  Image emissive_occlusion;    // occlusion -1: unlit
  std::vector<bool> blended;   // pixels over which a blended surface lies
};

// Draws and reads them. Uses the depth image of the last frame.
SurfaceImages read_surfaces(RenderView& v);

// Of the last frame, as light passes find them in its geometry buffer; without emission, and nothing of blended ones.
SurfaceImages read_gbuffer_surfaces(RenderView& v);

}  // namespace lightgrid
