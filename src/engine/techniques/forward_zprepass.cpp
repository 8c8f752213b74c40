// Each object with up to eight of its lights in a draw; the other lights in further draws, added up.
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) { return shade_by_objects(v, 8, false); }

extern const Technique forward_zprepass{
    .name = "forward_zprepass",
    .summary = "depth first, then up to eight lights a draw",
    .source = "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009",
    .needs = {.effects = all_effects,
              .surfaces = {.reversed_triangles = true},
              .lists = {.capped = true},
              .samples = {.most = 8}},
    .settings = {"brdf", "depth-bounds", "tile", "list-cap", "list-cap-order", "view-cap", "samples",
                 "samples-masks", "samples-resolve", "kernel-shape"},
    .render = render,
    .listed_by = ListedBy::object};

}  // namespace lightgrid
