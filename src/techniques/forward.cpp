// Every light at every pixel: the brute-force image that every other technique is compared with.
#include "techniques/technique.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
  const DepthImage depth = depth_prepass(f);
  const TileDistances distances = tile_distances(f, depth_bounds(f, depth));
  const ShadedImage image = shade_forward(f, distances, nullptr);
  shade_blended(f, image, nullptr);
  return image;
}

extern const Technique forward{.name = "forward",
                               .summary = "every light at every pixel",
                               .source = "the baseline",
                               .needs = {},
                               .settings = {"brdf", "depth-bounds", "tile"},
                               .render = render};

}  // namespace lightgrid
