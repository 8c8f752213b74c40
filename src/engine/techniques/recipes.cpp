#include "techniques/recipes.h"

#include "passes/cap_lists.h"
#include "passes/cull_lights.h"
#include "passes/find_object_lights.h"
#include "passes/resolve.h"
#include "passes/shade_forward.h"
#include "passes/shade_objects.h"
#include "passes/shade_tiles.h"
#include "plan/settings/samples.h"

namespace lightgrid {

ViewGrid list_lights(RenderView& v, Surfaces& surfaces) {
  if (v.plan.lists.light_tree)
    return lists_of_tree(v, v.caches.list_caps, v.culler().params(), bounds_of(v, surfaces).opaque,
                         v.opaque_grid());
  const DepthBounds bounds = cull_bounds_of(v, surfaces);
  ViewGrid grid = cull_lights(v, v.culler(), v.opaque_grid(), bounds);
  cap_lists(v, v.caches.list_caps, v.culler().params(), bounds.opaque, grid);
  return grid;
}

Frame shade_from_light_grid(RenderView& v) {
  Surfaces surfaces = find_surfaces(v, false, true);
  if (!v.plan.lists.light_grid)
    return shade_every_light(v, surfaces);  // no light has a position: nothing to list
  Frame frame = frame_of(v, surfaces);
  frame.grid = list_lights(v, surfaces);
  const LightSource lights = from_grid(v, *frame.grid);
  frame.image = shade(v, surfaces, lights);
  blend_from_grid(v, surfaces, lights, frame);
  return frame;
}

Frame shade_every_light(RenderView& v, const Surfaces& surfaces) {
  Frame frame = frame_of(v, surfaces);
  const LightSource lights = every_light(v);
  frame.image = shade(v, surfaces, lights);
  blend(v, surfaces, lights, frame.image);
  return frame;
}

void blend_from_grid(RenderView& v, Surfaces& surfaces, const LightSource& opaque, Frame& frame) {
  frame.listed = opaque.listed;
  if (surfaces.visible ? v.plan.surfaces.blended.empty() : !v.plan.surfaces.blend) return;
  if (!v.plan.lists.blend_grid) return blend(v, surfaces, opaque, frame.image);
  const DepthBounds& bounds = bounds_of(v, surfaces);
  if (v.plan.lists.light_tree) {
    frame.blend_grid =
        lists_of_tree(v, v.caches.list_caps, v.culler().params(), bounds.blend, v.blend_grid());
  } else {
    frame.blend_grid = cull_lights_for_blended(v, v.culler(), v.blend_grid(), bounds);
    cap_lists(v, v.caches.list_caps, v.culler().params(), bounds.blend, *frame.blend_grid);
  }
  blend(v, surfaces, from_grid(v, *frame.blend_grid), frame.image);
}

void adapt_shade_tiled(TechniqueNeeds& needs, Settings& settings) {
  if (settings[setting::samples_resolve] != SamplesResolve::linear) needs.samples.most = 1;
}

Frame shade_tiled(RenderView& v, std::optional<Surfaces> surfaces) {
  // If no light has a position, nothing adds to a geometry buffer. OpenGL fills it all the same, for its
  // image.
  if (!v.plan.lists.light_grid && !v.plan.opengl) return shade_every_light(v, *surfaces);
  const GBuffer gbuffer = fill_gbuffer(v, surfaces);
  Frame frame = frame_of(v, *surfaces);
  if (!v.plan.lists.light_grid) {
    frame.image = gbuffer.image;
    blend(v, *surfaces, every_light(v), frame.image);
    return frame;
  }
  const DepthBuffer& depth = depth_of(v, *surfaces);
  hand_over(v, gbuffer, *surfaces);
  frame.grid = list_lights(v, *surfaces);
  const LightSource lights = from_grid(v, *frame.grid);
  frame.image = shade_tiles(v, v.caches, gbuffer, depth, lights, frame);
  blend_from_grid(v, *surfaces, lights, frame);
  return frame;
}

Frame shade_by_objects(RenderView& v, uint32_t lights_a_draw, bool own_apart) {
  const ObjectLights& objects = find_object_lights(v, v.caches.object_lights, find_surfaces(v).drawn);
  const ShadedImage image = shade_objects(v, objects, lights_a_draw, own_apart);
  shade_blended(v, image, find_blended_object_lights(v, v.caches.blended_object_lights));
  return {.image = image, .listed = [&v](auto&) { return listed_of_objects(v, v.caches.object_lights); }};
}

}  // namespace lightgrid
