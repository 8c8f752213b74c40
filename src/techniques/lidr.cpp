// Light-indexed deferred rendering: light volumes drawn into images of light indices, then forward shading of
// the lights that a pixel's indices name (docs/techniques/lidr.md).
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/find_object_lights.h"
#include "passes/light_index.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, depth_bounds(v, depth)));
  if (v.plan.local.empty()) {
    const ShadedImage image = shade_forward(v, surfaces, every_light(v));
    shade_blended(v, image, every_light(v));
    return {image};
  }
  const LightIndexImages index = light_index(v);
  const LightSource lights = from_light_index(v, index);
  const ShadedImage image = shade_forward(v, surfaces, lights);
  // Stencil marks opaque surfaces only.
  if (v.plan.settings.lidr_volumes == LidrVolumes::front_faces) {
    shade_blended(v, image, lights);
  } else {
    shade_blended(v, image, find_blended_object_lights(v));
  }
  return {.image = image, .light_index_bytes = index.bytes};
}

static ListedLights listed(RenderView& v) {
  return v.plan.local.empty() ? list_every_light(0) : read_light_index(v);
}

extern const Technique lidr{
    .name = "lidr",
    .summary = "light volumes drawn into images of light indices",
    .source = "Trebilco: Light-Indexed Deferred Rendering, ShaderX7 2.9, 2009",
    .needs = {.stencil = true},
    .settings = {"brdf", "lidr-packing", "lidr-overlap", "lidr-lights", "lidr-volumes", "lidr-unpack",
                 "lidr-order", "volume-mesh", "depth-bounds", "tile", "kernel-shape"},
    .render = render,
    .listed = listed,
    .limited_lists = true};

}  // namespace lightgrid
