// The recipe that forward_plus, clustered and visibility share; the plan's slices, and who draws surfaces,
// make the difference.
#include "passes/cull_lights.h"
#include "techniques/technique.h"

namespace lightgrid {

Frame shade_from_light_grid(RenderView& v) {
  Surfaces surfaces = find_surfaces(v);
  if (!v.plan.light_grid) return shade_every_light(v, surfaces);  // no light has a position: nothing to list
  Frame frame = frame_of(surfaces);
  frame.grid = cull_lights(v, v.culler(), v.opaque_grid(), bounds_of(v, surfaces));
  const LightSource lights = from_grid(v, *frame.grid);
  frame.image = shade(v, surfaces, lights);
  blend_from_grid(v, surfaces, lights, frame);
  return frame;
}

Frame shade_every_light(RenderView& v, const Surfaces& surfaces) {
  Frame frame = frame_of(surfaces);
  const LightSource lights = every_light(v);
  frame.image = shade(v, surfaces, lights);
  blend(v, surfaces, lights, frame.image);
  return frame;
}

void blend_from_grid(RenderView& v, Surfaces& surfaces, const LightSource& opaque, Frame& frame) {
  frame.listed = opaque.listed;
  if (surfaces.visible ? v.plan.blended.empty() : !v.plan.blend) return;
  if (!v.plan.blend_grid) return blend(v, surfaces, opaque, frame.image);
  frame.blend_grid = cull_lights_for_blended(v, v.culler(), v.blend_grid(), bounds_of(v, surfaces));
  blend(v, surfaces, from_grid(v, *frame.blend_grid), frame.image);
}

}  // namespace lightgrid
