// Tiled deferred shading: geometry once, then every pixel's lights from its tile's list, in OpenCL.
#include "techniques/add_tiled_light.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
  const GBuffer gbuffer = fill_gbuffer(f, own_light_of(f));
  return add_tiled_light(f, gbuffer, depth_bounds(f, gbuffer.depth_image));
}

extern const Technique deferred_tiled{
    .name = "deferred_tiled",
    .summary = "a geometry buffer, lit in OpenCL from per-tile light lists",
    .source = "Lauritzen: Deferred Rendering for Current and Future Rendering Pipelines, SIGGRAPH 2010",
    .needs = {.light_grid = true, .lists = true, .z_bins = true},
    .settings = {"brdf", "buffer-bits", "cull-test", "depth-bounds", "tile", "slice-spacing", "z-bins",
                 "kernel-shape", "portable", "group-size"},
    .render = render};

}  // namespace lightgrid
