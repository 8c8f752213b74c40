// Light-indexed deferred rendering: light volumes drawn into images of light indices, then forward shading of the lights
// that a pixel's indices name (docs/techniques/lidr.md).
#include "passes/object_lights.h"
#include "techniques/technique.h"

namespace lightgrid {

static ShadedImage render(Frame& f) {
  const DepthImage depth = depth_prepass(f);
  const TileDistances distances = tile_distances(f, depth_bounds(f, depth));
  if (f.plan.local.empty()) {
    const ShadedImage image = shade_forward(f, distances, nullptr);
    shade_blended(f, image, nullptr);
    return image;
  }
  const LightIndexImages index = light_index(f);
  const ShadedImage image = shade_forward(f, distances, index);
  // A stencil knows what is inside a volume of opaque surfaces alone.
  if (f.plan.settings.lidr_volumes == LidrVolumes::front_faces) {
    shade_blended(f, image, index);
  } else {
    shade_blended(f, image, find_blended_object_lights(f));
  }
  return image;
}

static ListedLights listed(Frame& f) { return f.plan.local.empty() ? list_every_light(0) : read_light_index(f); }

extern const Technique lidr{
    .name = "lidr",
    .summary = "light volumes drawn into images of light indices",
    .source = "Trebilco: Light-Indexed Deferred Rendering, ShaderX7 2.9, 2009",
    .needs = {.stencil = true},
    .settings = {"brdf", "lidr-packing", "lidr-overlap", "lidr-lights", "lidr-volumes", "lidr-unpack", "lidr-order", "volume-mesh",
                 "depth-bounds", "tile"},
    .render = render,
    .listed = listed,
    .limited_lists = true};

}  // namespace lightgrid
