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
    .settings = settings_of_shade_tiled,
    .render = render};

}  // namespace lightgrid
