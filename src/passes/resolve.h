// From triangle numbers to radiance, in OpenCL: the resolve pass, and blended surfaces over its image.
#pragma once

#include "passes/rasterize.h"

namespace lightgrid {

// A light grid and where it lies; null: every light is added.
struct GridInCl {
  const LightGrid* grid = nullptr;
  SharedGridStorage* storage = nullptr;
};

// Attributes, textures and light of every pixel in one pass. The image stays in OpenCL's memory.
ShadedImage resolve(RenderView& v, const VisibilityBuffer& visible, const GridInCl& lights);

// Lays blended surfaces over the image of resolve(), where they are in front of the opaque ones.
void blend_resolved(RenderView& v, const BlendedTriangles& blended, const DepthBuffer& depth,
                    const GridInCl& lights);

}  // namespace lightgrid
