// Triangle numbers first, in OpenCL; then attributes, textures and light of each pixel in one pass, from its
// tile's list.
#include "plan/settings/grid.h"
#include "techniques/recipes.h"

namespace lightgrid {

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  needs.slices = settings.given(setting::slices);
  if (!needs.slices) settings.set(setting::slices, 1), needs.no_slices = "slices is not given";
  if (settings[setting::lights] == ShadedLights::all)
    needs.light_grid = needs.capped_lists = false, needs.no_light_grid = "lights=all";
}

extern const Technique visibility{
    .name = "visibility",
    .summary = "a visibility buffer, resolved and lit in OpenCL from per-tile light lists",
    .source = "Burns, Hunt: The Visibility Buffer, JCGT 2013",
    .needs = {.effects = all_effects,
              .light_grid = true,
              .lists = true,
              .z_bins = true,
              .opengl = false,
              .group_tiles = true,
              .capped_lists = true,
              .sampled_lists = true,
              .most_samples = 8,
              .adapt = adapt},
    .settings = {"brdf",     "cull-test",      "depth-bounds",  "tile",
                 "slices",   "slice-spacing",  "z-bins",        "group-tiles",
                 "list-cap", "list-cap-order", "list-seed",     "view-cap",
                 "lights",   "samples",        "samples-masks", "samples-resolve",
                 "texels",   "kernel-shape",   "portable",      "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
