// Light-indexed deferred rendering: light volumes drawn into images of light indices, then forward shading of
// the lights that a pixel's indices name (docs/techniques/lidr.md).
#include "passes/find_object_lights.h"
#include "passes/light_index.h"
#include "passes/shade_forward.h"
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  const Surfaces surfaces = find_surfaces(v);
  if (v.plan.local.empty()) return shade_every_light(v, surfaces);
  const LightSource lights = light_index(v, v.caches.light_index, v.caches.light_volumes);
  const ShadedImage image = shade(v, surfaces, lights);
  // Stencil marks opaque surfaces only.
  if (v.plan.settings.lidr_volumes == LidrVolumes::front_faces) {
    blend(v, surfaces, lights, image);
  } else {
    shade_blended(v, image, find_blended_object_lights(v, v.caches.blended_object_lights));
  }
  return {.image = image, .listed = lights.listed, .list_bytes = lights.bytes};
}

extern const Technique lidr{
    .name = "lidr",
    .summary = "light volumes drawn into images of light indices",
    .source = "Trebilco: Light-Indexed Deferred Rendering, ShaderX7 2.9, 2009",
    .needs = {.stencil = true},
    .settings = {"brdf", "lidr-packing", "lidr-overlap", "lidr-lights", "lidr-volumes", "lidr-unpack",
                 "lidr-order", "volume-mesh", "depth-bounds", "tile", "kernel-shape"},
    .render = render,
    .listed_by = ListedBy::pixel,
    .limited_lists = true};

}  // namespace lightgrid
