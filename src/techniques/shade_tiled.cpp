#include "techniques/shade_tiled.h"

#include "passes/cull_lights.h"
#include "passes/fill_gbuffer.h"
#include "passes/resolve.h"
#include "passes/shade_tiles.h"

namespace lightgrid {
namespace {

// Without point and spot lights there is no light pass, and the image takes all.
BaseLighting base_lighting_of(const RenderView& v) {
  return v.plan.light_grid && !v.plan.base_lighting ? BaseLighting::in_light_pass : BaseLighting::in_image;
}

GBuffer fill(RenderView& v, std::optional<Surfaces>& surfaces) {
  if (!surfaces) {
    const GBuffer gbuffer = fill_gbuffer(v, base_lighting_of(v));
    surfaces = Surfaces{.image = gbuffer.depth_image};
    return gbuffer;
  }
  if (!surfaces->visible) return fill_gbuffer(v, surfaces->drawn, base_lighting_of(v));
  GBuffer gbuffer;
  gbuffer.in_cl = resolve_gbuffer(v, v.caches.resolver, *surfaces->visible, base_lighting_of(v));
  return gbuffer;
}

}  // namespace

Frame shade_tiled(RenderView& v, std::optional<Surfaces> surfaces) {
  // If no light has a position, nothing adds to a geometry buffer. OpenGL fills it all the same, for its
  // image.
  if (!v.plan.light_grid && !v.plan.opengl) return shade_every_light(v, *surfaces);
  const GBuffer gbuffer = fill(v, surfaces);
  Frame frame = frame_of(*surfaces);
  if (!v.plan.light_grid) {
    frame.image = gbuffer.image;
    blend(v, *surfaces, every_light(v), frame.image);
    return frame;
  }
  const DepthBuffer& depth = depth_of(v, *surfaces);
  frame.grid = cull_lights(v, v.culler(), v.opaque_grid(), bounds_of(v, *surfaces));
  const LightSource lights = from_grid(v, *frame.grid);
  frame.image = shade_tiles(v, v.caches.tile_shading, gbuffer, depth, lights);
  blend_from_grid(v, *surfaces, lights, frame);
  return frame;
}

}  // namespace lightgrid
