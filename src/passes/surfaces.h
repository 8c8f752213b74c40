// The surfaces that shading saw, for the oracle: not part of any technique's frame.
#pragma once

#include "passes/passes.h"

namespace lightgrid {

struct SurfaceImages {
  Image normal_roughness;      // view-space shading normal; perceptual roughness
  Image base_color_metallic;
  Image emissive_occlusion;    // occlusion -1: unlit
  std::vector<bool> blended;   // pixels over which a blended surface lies
};

// Draws and reads them. Uses the depth image of the last frame.
SurfaceImages read_surfaces(Frame& f);

// Of the last frame, as light passes find them in its geometry buffer; without emission, and nothing of blended ones.
SurfaceImages read_gbuffer_surfaces(Frame& f);

}  // namespace lightgrid
