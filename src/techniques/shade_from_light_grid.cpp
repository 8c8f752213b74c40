// What forward_plus and clustered share: they differ in what the plan makes of a tile.
#include "techniques/technique.h"

namespace lightgrid {

ShadedImage shade_from_light_grid(Frame& f) {
  const DepthImage depth = depth_prepass(f);
  const DepthBounds bounds = depth_bounds(f, depth);
  const TileDistances distances = tile_distances(f, bounds);
  if (!f.plan.light_grid) {  // no light has a place: there is nothing to list
    const ShadedImage image = shade_forward(f, distances, nullptr);
    shade_blended(f, image, nullptr);
    return image;
  }
  const GridTextures grid = cull_lights(f, bounds);
  const ShadedImage image = shade_forward(f, distances, &grid);
  if (f.plan.blend_grid) {
    const GridTextures blend_grid = cull_lights_for_blended(f, bounds);
    shade_blended(f, image, &blend_grid);
  } else {
    shade_blended(f, image, &grid);
  }
  return image;
}

}  // namespace lightgrid
