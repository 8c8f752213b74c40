// Tiled deferred shading: geometry once, then every pixel's lights from its tile's list, in OpenCL.
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  return shade_tiled(v, v.plan.opengl ? std::nullopt : std::optional(find_surfaces(v)));
}

extern const Technique deferred_tiled{
    .name = "deferred_tiled",
    .summary = "a geometry buffer, lit in OpenCL from per-tile light lists",
    .source = "Lauritzen: Deferred Rendering for Current and Future Rendering Pipelines, SIGGRAPH 2010",
    .needs = needs_of_shade_tiled,
    .settings = settings_of_shade_tiled,
    .render = render};

}  // namespace lightgrid
