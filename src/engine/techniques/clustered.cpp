// Forward shading from light lists of clusters: tiles cut into depth slices. Without depth bounds one grid
// serves opaque and blended surfaces (docs/techniques/clustered.md).
#include "plan/settings/masks.h"
#include "techniques/recipes.h"

namespace lightgrid {

extern const Technique clustered{
    .name = "clustered",
    .summary = "light lists of tiles cut into depth slices",
    .source = "Olsson, Billeter, Assarsson: Clustered Shading, HPG 2012",
    .needs = {.effects = all_effects,
              .lists = {.light_grid = true, .slices = true, .z_bins = true, .capped = true, .sampled = true},
              .masks = {.tiles = true},
              .samples = {.most = 8}},
    .settings = {"brdf",
                 "cull-test",
                 "depth-bounds",
                 "tile",
                 "slices",
                 "slice-spacing",
                 "z-bins",
                 setting::number_bits_key,
                 setting::tile_masks_key,
                 "grid-lists",
                 "list-cap",
                 "list-cap-order",
                 "list-seed",
                 "view-cap",
                 "samples",
                 "samples-masks",
                 "samples-resolve",
                 "kernel-shape",
                 "portable",
                 "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
