// Forward shading from per-tile light lists, culled in OpenCL against the depth bounds of each tile.
#include "plan/settings/masks.h"
#include "techniques/recipes.h"

namespace lightgrid {

extern const Technique forward_plus{
    .name = "forward_plus",
    .summary = "per-tile light lists",
    .source = "Harada, McKee, Yang: Forward+, Eurographics 2012",
    .needs = {.effects = all_effects,
              .lists = {.light_grid = true, .z_bins = true, .capped = true, .sampled = true},
              .masks = {.tiles = true},
              .samples = {.most = 8}},
    .settings = {"brdf", "cull-test", "depth-bounds", "tile", "slice-spacing", "z-bins",
                 setting::number_bits_key, setting::tile_masks_key, "grid-lists", "list-cap",
                 "list-cap-order", "list-seed", "view-cap", "samples", "samples-masks", "samples-resolve",
                 "kernel-shape", "portable", "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
