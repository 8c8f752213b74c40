// Forward shading from per-tile light lists, culled in OpenCL against the depth bounds of each tile.
#include "techniques/technique.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
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
  }
  return image;
}

extern const Technique forward_plus{"forward_plus", "per-tile light lists",
                                    "Harada, McKee, Yang: Forward+, Eurographics 2012", {.light_grid = true}, render};

}  // namespace lightgrid
