// Each object once for base lighting, then once more for each light that reaches it, added up.
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) { return shade_by_objects(v, 1, true); }

extern const Technique forward_multipass{
    .name = "forward_multipass",
    .summary = "an additive pass for each object and light",
    .source = "the baseline of Trebilco: Light Indexed Deferred Rendering, ShaderX7, 2009",
    .needs = {.effects = all_effects,
              .surfaces = {.reversed_triangles = true},
              .lists = {.capped = true},
              .samples = {.most = 8}},
    .settings = {"brdf", "depth-bounds", "tile", "list-cap", "list-cap-order", "view-cap", "samples",
                 "samples-masks", "samples-resolve", "kernel-shape"},
    .render = render,
    .listed_by = ListedBy::object};

}  // namespace lightgrid
