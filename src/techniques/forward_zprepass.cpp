// Each object with up to eight of the lights that reach it in a draw; what more
// there are in further draws, added up.
#include "passes/object_lights.h"
#include "techniques/technique.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
  const DepthImage depth = depth_prepass(f);
  const TileDistances distances = tile_distances(f, depth_bounds(f, depth));
  const ObjectLights& objects = find_object_lights(f, distances);
  const ShadedImage image = shade_objects(f, objects, 8, false);
  shade_blended(f, image, find_blended_object_lights(f));
  return image;
}

extern const Technique forward_zprepass{
    .name = "forward_zprepass",
    .summary = "depth first, then up to eight lights a draw",
    .source = "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009",
    .needs = {.reversed_triangles = true},
    .settings = {"brdf", "depth-bounds", "tile"},
    .render = render,
    .listed = listed_of_objects};

}  // namespace lightgrid
