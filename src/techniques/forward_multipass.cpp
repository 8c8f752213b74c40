// Each object once for its own light, then once more for each light that reaches it, added up.
#include "passes/object_lights.h"
#include "techniques/technique.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
  const DepthImage depth = depth_prepass(f);
  const TileDistances distances = tile_distances(f, depth_bounds(f, depth));
  const ObjectLights& objects = find_object_lights(f, distances);
  const ShadedImage image = shade_objects(f, objects, 1, true);
  shade_blended(f, image, find_blended_object_lights(f));
  return image;
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
