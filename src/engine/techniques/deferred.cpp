// Surfaces into a geometry buffer, then lights: one after the other, each on the pixels that its volume covers,
// or all of them in one pass over the screen.
#include "passes/find_object_lights.h"
#include "passes/shade_forward.h"
#include "passes/shade_light_volumes.h"
#include "plan/settings/masks.h"
#include "plan/settings/surfaces.h"
#include "techniques/recipes.h"

namespace lightgrid {

static const Setting<bool> full_screen{
    205,
    "light-pass",
    "how lights are added to the geometry buffer: one by one, each where its volume is on screen, or all of "
    "them at every pixel in one pass over the screen",
    {{"volumes", false}, {"full-screen", true}}};

static Frame render(RenderView& v) {
  std::optional<Surfaces> surfaces;
  const GBuffer gbuffer = fill_gbuffer(v, surfaces);
  const bool volumes = !v.plan.settings[full_screen];
  if (volumes)
    shade_light_volumes(v, v.caches.light_volumes, gbuffer);
  else
    shade_full_screen(v, gbuffer);
  shade_blended(v, gbuffer.image, find_blended_object_lights(v, v.caches.blended_object_lights));
  Frame frame{.image = gbuffer.image};
  if (volumes) frame.listed = listed_of_light_volumes(v, v.caches.light_volumes);
  return frame;
}

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  needs.masks.stencil = !settings[full_screen];
  needs.surfaces.stencil = needs.masks.stencil && settings[setting::volume_culling] == VolumeCulling::stencil;
}

extern const Technique deferred{
    .name = "deferred",
    .summary = "geometry buffer, then light volumes",
    .source = "Engel: Designing a Renderer for Multiple Lights, ShaderX7, 2009",
    .needs = {.effects = all_effects, .masks = {.stencil = true}, .samples = {.most = 8}, .adapt = adapt},
    .settings = {"brdf", "buffer-bits", "light-pass", "volume-culling", setting::number_bits_key,
                 setting::stencil_masks_key, "volume-mesh", "samples", "samples-masks", "samples-resolve"},
    .render = render,
    .listed_by = ListedBy::pixel};

}  // namespace lightgrid
