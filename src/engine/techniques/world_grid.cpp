// Forward shading from light lists in cells of the world, which serve every view and change only when
// lights move (docs/techniques/world_grid.md).
#include "passes/build_world_grid.h"
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  const Surfaces surfaces = find_surfaces(v);
  if (!v.plan.lists.world_grid) return shade_every_light(v, surfaces);
  const LightSource lights = build_world_grid(v, v.caches.world_grid);
  Frame frame = frame_of(v, surfaces);
  frame.listed = lights.listed;
  frame.image = shade(v, surfaces, lights);
  blend(v, surfaces, lights, frame.image);
  frame.list_bytes = lights.bytes;
  frame.built_by = "build_world_grid";
  frame.built_with = {{"world_cell", built_world_grid(v, v.caches.world_grid).layout().cell}};
  return frame;
}

extern const Technique world_grid{
    .name = "world_grid",
    .summary = "light lists in cells of the world, built once for all views",
    .source =
        "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009; "
        "Tegelaers: Forward and Deferred Hashed Shading",
    .needs = {.effects = all_effects,
              .surfaces = {.chosen_raster = true},
              .lists = {.world_grid = true},
              .samples = {.most = 8}},
    .settings = {"brdf", "world-grid", "world-cell", "depth-bounds", "tile", "raster", "samples",
                 "samples-masks", "samples-resolve", "texels", "kernel-shape", "portable"},
    .render = render};

}  // namespace lightgrid
