// Triangle numbers first, in OpenCL; then attributes, textures and light of each pixel in one pass, from its
// tile's list.
#include "techniques/recipes.h"

namespace lightgrid {

extern const Technique visibility{
    .name = "visibility",
    .summary = "a visibility buffer, resolved and lit in OpenCL from per-tile light lists",
    .source = "Burns, Hunt: The Visibility Buffer, JCGT 2013",
    .needs = {.light_grid = true,
              .given_slices = true,
              .lists = true,
              .z_bins = true,
              .opengl = false,
              .chosen_lights = true},
    .settings = {"brdf", "cull-test", "depth-bounds", "tile", "slices", "slice-spacing", "z-bins", "lights",
                 "texels", "kernel-shape", "portable", "group-size"},
    .render = shade_from_light_grid};

}  // namespace lightgrid
