// The part that forward_plus and clustered share; the plan's slices make the difference.
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {

Frame shade_from_light_grid(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const DepthBounds bounds = depth_bounds(v, depth);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, bounds));
  Frame frame;
  if (!v.plan.light_grid) {  // no light has a position: nothing to list
    frame.image = shade_forward(v, surfaces, every_light(v));
    shade_blended(v, frame.image, every_light(v));
    return frame;
  }
  frame.grid = cull_lights(v, bounds);
  frame.image = shade_forward(v, surfaces, from_grid(v, grid_to_gl(v, *frame.grid, v.opaque_grid())));
  shade_blended_from_grid(v, bounds, frame);
  return frame;
}

void shade_blended_from_grid(RenderView& v, const DepthBounds& bounds, Frame& frame) {
  if (!v.plan.blend) return;
  if (v.plan.blend_grid) frame.blend_grid = cull_lights_for_blended(v, bounds);
  const GridTextures lists = v.plan.blend_grid ? grid_to_gl(v, *frame.blend_grid, v.blend_grid())
                                               : grid_to_gl(v, *frame.grid, v.opaque_grid());
  shade_blended(v, frame.image, from_grid(v, lists));
}

}  // namespace lightgrid
