// The part that deferred_tiled and forward_plus_compute share; they fill the geometry buffer differently.
#pragma once

#include "passes/common/gbuffer.h"
#include "techniques/technique.h"

namespace lightgrid {

// Without point and spot lights there is no light pass, and the image takes all.
inline BaseLighting base_lighting_of(const RenderView& v) {
  return v.plan.light_grid && !v.plan.base_lighting ? BaseLighting::in_light_pass : BaseLighting::in_image;
}

// Culls lights, adds those of each tile's list to the geometry buffer's image, and blends blended surfaces
// over it.
Frame add_tiled_light(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth,
                      const DepthBounds& bounds);

// The same without point and spot lights: the geometry buffer's image lacks only blended surfaces.
Frame without_tiled_light(RenderView& v, const GBuffer& gbuffer);

// The whole frame with raster=opencl: triangles, surfaces and light in OpenCL. Both techniques then have the
// depth before the surfaces, and each pixel's material once.
Frame tiled_light_in_cl(RenderView& v);

}  // namespace lightgrid
