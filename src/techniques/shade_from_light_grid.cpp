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
  shade_blended_from_grid(f, image, bounds, grid.grid);
  return image;
}

void shade_blended_from_grid(Frame& f, const ShadedImage& image, const DepthBounds& bounds, const LightGrid& grid) {
  if (!f.plan.blend) return;
  const GridTextures lists = f.plan.blend_grid ? cull_lights_for_blended(f, bounds) : grid_to_gl(f, grid);
  shade_blended(f, image, &lists);
}

}  // namespace lightgrid
