// Every light at every pixel: the brute-force image that every other technique is compared with.
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const TileDistances distances = tile_distances(v, depth_bounds(v, depth));
  const LightSource lights = every_light(v);
  const ShadedImage image = shade_forward(v, visible_surfaces(v, distances), lights);
  shade_blended(v, image, lights);
  return {image};
}

extern const Technique forward{.name = "forward",
                               .summary = "every light at every pixel",
                               .source = "the baseline",
                               .needs = {},
                               .settings = {"brdf", "depth-bounds", "tile", "kernel-shape"},
                               .render = render};

}  // namespace lightgrid
