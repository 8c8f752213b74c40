// Triangle numbers first, in OpenCL; then attributes, textures and light of each pixel in one pass, from its
// tile's list.
#include "plan/settings/grid.h"
#include "plan/settings/masks.h"
#include "techniques/recipes.h"

namespace lightgrid {

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  needs.lists.slices = settings.given(setting::slices);
  if (!needs.lists.slices) {
    settings.set(setting::slices, 1);
    needs.lists.no_slices = "slices is not given";
  }
  if (settings[setting::lights] == ShadedLights::all) {
    needs.lists.light_grid = needs.lists.capped = false;
    needs.lists.no_light_grid = "lights=all";
  }
}

extern const Technique visibility{
    .name = "visibility",
    .summary = "a visibility buffer, resolved and lit in OpenCL from per-tile light lists",
    .source = "Burns, Hunt: The Visibility Buffer, JCGT 2013",
    .needs =
        {.effects = all_effects,
         .surfaces = {.opengl = false},
         .lists = {.light_grid = true, .z_bins = true, .no_masks = true, .capped = true, .sampled = true},
         .masks = {.tiles = true},
         .samples = {.most = 8},
         .adapt = adapt},
    .settings = {"brdf",     "cull-test",      "depth-bounds",  "tile",
                 "slices",   "slice-spacing",  "z-bins",        setting::tile_masks_key,
                 "list-cap", "list-cap-order", "list-seed",     "view-cap",
                 "lights",   "samples",        "samples-masks", "samples-resolve",
                 "texels",   "kernel-shape",   "portable",      "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
