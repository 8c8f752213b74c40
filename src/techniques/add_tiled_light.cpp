#include "techniques/add_tiled_light.h"

#include "passes/shade_tiles.h"

namespace lightgrid {

ShadedImage add_tiled_light(Frame& f, const GBuffer& gbuffer, const DepthBounds& bounds) {
  if (!f.plan.light_grid) {  // no light has a place: the image is finished
    shade_blended(f, gbuffer.image, nullptr);
    return gbuffer.image;
  }
  const LightGrid grid = cull_lights_for_cl(f, bounds);
  const ShadedImage image = shade_tiles(f, gbuffer, grid);
  shade_blended_from_grid(f, image, bounds, grid);
  return image;
}

}  // namespace lightgrid
