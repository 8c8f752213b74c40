#include "techniques/add_tiled_light.h"

#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/resolve.h"
#include "passes/shade_blended.h"
#include "passes/shade_tiles.h"

namespace lightgrid {

Frame add_tiled_light(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth,
                      const DepthBounds& bounds) {
  if (!v.plan.light_grid) return without_tiled_light(v, gbuffer);
  Frame frame;
  frame.grid = cull_lights(v, bounds);
  frame.image = shade_tiles(v, gbuffer, depth, *frame.grid);
  shade_blended_from_grid(v, bounds, frame);
  return frame;
}

Frame without_tiled_light(RenderView& v, const GBuffer& gbuffer) {
  shade_blended(v, gbuffer.image, every_light(v));
  return {gbuffer.image};
}

Frame tiled_light_in_cl(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = visible.triangles();
  DepthBounds bounds;
  if (v.plan.light_grid) {
    const GBufferInCl gbuffer = resolve_gbuffer(v, visible, base_lighting_of(v));
    bounds = depth_bounds(v, *frame.depth);
    frame.grid = cull_lights(v, bounds);
    frame.image = shade_tiles(v, gbuffer, *frame.depth, *frame.grid);
  } else {
    frame.image = resolve(v, visible, {});  // no light has a position: nothing reads a geometry buffer
  }
  blend_resolved_from_grid(v, bounds, frame);
  return frame;
}

}  // namespace lightgrid
