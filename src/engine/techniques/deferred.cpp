// Surfaces into a geometry buffer, then the lights one after the other, each on the pixels that its volume
// covers.
#include "passes/find_object_lights.h"
#include "passes/shade_forward.h"
#include "passes/shade_light_volumes.h"
#include "plan/settings/masks.h"
#include "plan/settings/surfaces.h"
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  std::optional<Surfaces> surfaces;
  const GBuffer gbuffer = fill_gbuffer(v, surfaces);
  shade_light_volumes(v, v.caches.light_volumes, gbuffer);
  shade_blended(v, gbuffer.image, find_blended_object_lights(v, v.caches.blended_object_lights));
  return {.image = gbuffer.image, .listed = listed_of_light_volumes(v, v.caches.light_volumes)};
}

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  needs.surfaces.stencil = settings[setting::volume_culling] == VolumeCulling::stencil;
}

extern const Technique deferred{
    .name = "deferred",
    .summary = "geometry buffer, then light volumes",
    .source = "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009",
    .needs = {.effects = all_effects, .masks = {.stencil = true}, .samples = {.most = 8}, .adapt = adapt},
    .settings = {"brdf", "buffer-bits", "volume-culling", setting::number_bits_key,
                 setting::stencil_masks_key, "volume-mesh", "samples", "samples-masks", "samples-resolve"},
    .render = render,
    .listed_by = ListedBy::pixel};

}  // namespace lightgrid
