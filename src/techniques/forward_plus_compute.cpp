// Forward+ with its light loop in OpenCL, 16 pixels at once on a CPU: a depth prepass, culling, then only the
// visible surfaces go through memory to the loop.
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/fill_gbuffer.h"
#include "techniques/add_tiled_light.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  if (v.plan.settings.raster == RasterApi::opencl) return tiled_light_in_cl(v);
  const DepthBuffer depth = depth_to_cl(v, depth_prepass(v));
  const DepthBounds bounds = depth_bounds(v, depth);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, bounds));
  return add_tiled_light(v, fill_gbuffer(v, surfaces, base_lighting_of(v)), depth, bounds);
}

extern const Technique forward_plus_compute{
    .name = "forward_plus_compute",
    .summary = "per-tile light lists, shaded in OpenCL",
    .source = "Harada, McKee, Yang: Forward+, Eurographics 2012; the loop as in Lauritzen, SIGGRAPH 2010",
    .needs = {.light_grid = true, .lists = true, .z_bins = true, .chosen_raster = true},
    .settings = {"brdf", "buffer-bits", "cull-test", "depth-bounds", "tile", "slice-spacing", "z-bins",
                 "raster", "texels", "kernel-shape", "portable", "group-size"},
    .render = render};

}  // namespace lightgrid
