// The surfaces as shading read them, for the oracle: not part of any technique's frame.
#pragma once

#include "base/image.h"
#include "passes/common/frame.h"

namespace lightgrid {

struct SurfaceImages {
  Image normal_roughness;  // view-space shading normal; perceptual roughness
  Image base_color_metallic;
  Image emissive_occlusion;                  // occlusion -1: unlit
  Image coat_normal_roughness, coat_factor;  // as above; red. Empty if no material in view has a coat
  Image model;  // red: the number. Empty if no material in view has a model but Lambert's
  std::vector<MaterialModel> models;  // by number
  Image specular;  // f0, f90 of the dielectric part. Empty if no material in view has another than 0.04, 1
  std::vector<bool> blended;  // pixels covered by a blended surface
};

// Draws and reads them. Uses the depth image of the last frame.
SurfaceImages read_surfaces(Work& work, const Seen& seen);

// The surfaces of the last frame from its geometry buffer; without emission and blended surfaces.
SurfaceImages read_gbuffer_surfaces(Work& work, const Seen& seen);

}  // namespace lightgrid
