#include "techniques/add_tiled_light.h"

#include "passes/cull_lights.h"
#include "passes/shade_blended.h"
#include "passes/shade_tiles.h"

namespace lightgrid {

Frame add_tiled_light(RenderView& v, const GBuffer& gbuffer, const DepthBuffer& depth, const DepthBounds& bounds) {
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

}  // namespace lightgrid
