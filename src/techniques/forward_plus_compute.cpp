// Forward+ with its light loop in OpenCL, 16 pixels at once on a CPU: a depth prepass, culling, then only the
// visible surfaces go through memory to the loop.
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) { return shade_tiled(v, find_surfaces(v, true)); }

extern const Technique forward_plus_compute{
    .name = "forward_plus_compute",
    .summary = "per-tile light lists, shaded in OpenCL",
    .source = "Harada, McKee, Yang: Forward+, Eurographics 2012; the loop as in Lauritzen, SIGGRAPH 2010",
    .needs = needs_of_shade_tiled,
    .settings = {"brdf",          "buffer-bits",     "group-ids",
                 "group-tiles",   "cull-test",       "depth-bounds",
                 "tile",          "slice-spacing",   "z-bins",
                 "list-cap",      "list-cap-order",  "list-seed",
                 "view-cap",      "raster",          "samples",
                 "samples-masks", "samples-shading", "texels",
                 "kernel-shape",  "portable",        "group-size"},
    .render = render};

}  // namespace lightgrid
