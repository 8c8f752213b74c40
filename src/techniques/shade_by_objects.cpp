#include "techniques/shade_by_objects.h"

#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/shade_blended.h"
#include "passes/shade_objects.h"

namespace lightgrid {

Frame shade_by_objects(RenderView& v, uint32_t lights_a_draw, bool own_apart) {
  const DepthImage depth = depth_prepass(v);
  const TileDistances distances = tile_distances(v, depth_bounds(v, depth));
  const ObjectLights& objects = find_object_lights(v, visible_surfaces(v, distances));
  const ShadedImage image = shade_objects(v, objects, lights_a_draw, own_apart);
  shade_blended(v, image, find_blended_object_lights(v));
  return {image};
}

}  // namespace lightgrid
