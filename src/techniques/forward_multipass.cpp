// Each object once for base lighting, then once more for each light that reaches it, added up.
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/shade_blended.h"
#include "passes/shade_objects.h"
#include "techniques/technique.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const TileDistances distances = tile_distances(v, depth_bounds(v, depth));
  const ObjectLights& objects = find_object_lights(v, visible_surfaces(v, distances));
  const ShadedImage image = shade_objects(v, objects, 1, true);
  shade_blended(v, image, find_blended_object_lights(v));
  return {image};
}

extern const Technique forward_multipass{
    .name = "forward_multipass",
    .summary = "an additive pass for each object and light",
    .source = "the baseline of Trebilco: Light Indexed Deferred Rendering, ShaderX7, 2009",
    .needs = {.reversed_triangles = true},
    .settings = {"brdf", "depth-bounds", "tile"},
    .render = render,
    .listed = listed_of_objects};

}  // namespace lightgrid
