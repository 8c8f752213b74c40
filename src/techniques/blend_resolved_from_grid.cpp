// Blended surfaces over an image that resolve() drew, lit from the light grid.
#include "passes/cull_lights.h"
#include "passes/resolve.h"
#include "techniques/technique.h"

namespace lightgrid {

void blend_resolved_from_grid(RenderView& v, const DepthBounds& bounds, Frame& frame) {
  if (v.plan.blended.empty()) return;
  if (v.plan.blend_grid) frame.blend_grid = cull_lights_for_blended(v, bounds);
  GridInCl lights;
  if (v.plan.light_grid) lights = {&*frame.grid, &v.opaque_grid()};
  if (v.plan.blend_grid) lights = {&*frame.blend_grid, &v.blend_grid()};
  blend_resolved(v, list_blended(v), *frame.depth, lights);
}

}  // namespace lightgrid
