// Every light at every pixel: the brute-force image that every other technique is compared with.
#include "techniques/recipes.h"

namespace lightgrid {

extern const Technique forward{
    .name = "forward",
    .summary = "every light at every pixel",
    .source = "the baseline",
    .needs = {.effects = all_effects, .samples = {.most = 8}},
    .settings = {"brdf", "depth-bounds", "tile", "samples", "samples-masks", "samples-resolve",
                 "kernel-shape"},
    .render = [](RenderView& v) { return shade_every_light(v, find_surfaces(v)); }};

}  // namespace lightgrid
