// Forward shading from per-tile light lists, culled in OpenCL against the depth bounds of each tile.
#include "techniques/recipes.h"

namespace lightgrid {

extern const Technique forward_plus{
    .name = "forward_plus",
    .summary = "per-tile light lists",
    .source = "Harada, McKee, Yang: Forward+, Eurographics 2012",
    .needs = {.effects = all_effects,
              .light_grid = true,
              .z_bins = true,
              .group_tiles = true,
              .capped_lists = true,
              .sampled_lists = true,
              .most_samples = 8},
    .settings = {"brdf", "cull-test", "depth-bounds", "tile", "slice-spacing", "z-bins", "group-ids",
                 "group-tiles", "grid-lists", "list-cap", "list-cap-order", "list-seed", "view-cap",
                 "samples", "samples-masks", "samples-resolve", "kernel-shape", "portable", "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
