// Each object with up to eight of its lights in a draw; the other lights in further draws, added up.
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
  const ShadedImage image = shade_objects(v, objects, 8, false);
  shade_blended(v, image, find_blended_object_lights(v));
  return {image};
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
