// Tiled deferred shading: geometry once, then every pixel's lights from its tile's list, in OpenCL.
#include "passes/depth_bounds.h"
#include "passes/fill_gbuffer.h"
#include "techniques/add_tiled_light.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  if (v.plan.settings.raster == RasterApi::opencl) return tiled_light_in_cl(v);
  const GBuffer gbuffer = fill_gbuffer(v, base_lighting_of(v));
  if (!v.plan.light_grid) return without_tiled_light(v, gbuffer);
  const DepthBuffer depth = depth_to_cl(v, gbuffer.depth_image);
  return add_tiled_light(v, gbuffer, depth, depth_bounds(v, depth));
}

extern const Technique deferred_tiled{
    .name = "deferred_tiled",
    .summary = "a geometry buffer, lit in OpenCL from per-tile light lists",
    .source = "Lauritzen: Deferred Rendering for Current and Future Rendering Pipelines, SIGGRAPH 2010",
    .needs = {.light_grid = true, .lists = true, .z_bins = true, .chosen_raster = true},
    .settings = {"brdf", "buffer-bits", "cull-test", "depth-bounds", "tile", "slice-spacing", "z-bins",
                 "raster", "texels", "kernel-shape", "portable", "group-size"},
    .render = render};

}  // namespace lightgrid
