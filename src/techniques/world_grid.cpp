// Forward shading from light lists in cells of the world, which serve every view and change only when
// lights move (docs/techniques/world_grid.md).
#include "passes/build_world_grid.h"
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/read_outs/depth.h"
#include "passes/resolve.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {

static void note_lists(Frame& frame, const SharedWorldGrid& grid) {
  frame.world_grid_bytes = grid.list_bytes();
  frame.world_cell = grid.layout().cell;
}

// The same with triangles rasterised and shaded in OpenCL.
static Frame render_in_cl(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = visible.triangles();
  std::optional<WorldGridInCl> lights;
  if (v.plan.world_grid) lights = build_world_grid(v);
  frame.image = resolve(v, visible, {.world = lights ? &*lights : nullptr});
  if (!v.plan.blended.empty())
    blend_resolved(v, list_blended(v), *frame.depth, {.world = lights ? &*lights : nullptr});
  if (lights) note_lists(frame, *lights->grid);
  return frame;
}

static Frame render(RenderView& v) {
  if (v.plan.settings.raster == RasterApi::opencl) return render_in_cl(v);
  const DepthImage depth = depth_prepass(v);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, depth_bounds(v, depth)));
  const LightSource lights = v.plan.world_grid ? from_world_grid(v) : every_light(v);
  Frame frame{.image = shade_forward(v, surfaces, lights)};
  shade_blended(v, frame.image, lights);
  if (v.plan.world_grid) note_lists(frame, built_world_grid(v));
  return frame;
}

extern const Technique world_grid{.name = "world_grid",
                                  .summary = "light lists in cells of the world, built once for all views",
                                  .source =
                                      "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009; "
                                      "Tegelaers: Forward and Deferred Hashed Shading",
                                  .needs = {.chosen_raster = true, .world_grid = true},
                                  .settings = {"brdf", "world-grid", "world-cell", "depth-bounds", "tile",
                                               "raster", "texels", "kernel-shape", "portable"},
                                  .render = render,
                                  .listed_at = [](RenderView& v, const std::vector<float>& depth) {
                                    return v.plan.world_grid
                                               ? listed_of_world_grid(v, depth)
                                               : list_every_light(uint32_t(v.plan.local.size()));
                                  }};

}  // namespace lightgrid
