// Light-indexed deferred rendering: light volumes drawn into images of light indices, then forward shading of
// the lights that a pixel's indices name (docs/techniques/lidr.md).
#include "base/error.h"
#include "passes/depth_prepass.h"
#include "passes/find_object_lights.h"
#include "passes/light_index.h"
#include "passes/light_index/lidr_settings.h"
#include "passes/shade_forward.h"
#include "plan/settings/shadows.h"
#include "techniques/recipes.h"

namespace lightgrid {

// Shadow volumes and groups of still lights are of the nearest surfaces; behind front faces lights are listed
// for all that lie before them.
static void refuse_impossible(const FramePlan& plan) {
  const Settings& settings = plan.settings;
  const bool front_faces = settings[setting::lidr_volumes] != LidrVolumes::stencil;
  if (settings[setting::lidr_shadows] == LidrShadows::volumes && front_faces) {
    throw input_error(
        "lidr: shadow volumes mark opaque surfaces, but lidr-volumes=front-faces lists lights for all that "
        "lies before them; use lidr-volumes=stencil, or lidr-shadows=prepass");
  }
  const bool sorted = settings[setting::lidr_packing] == LidrPacking::sort ||
                      settings[setting::lidr_packing] == LidrPacking::maxblend_sort;
  if (sorted && settings[setting::lidr_sort] == LidrSort::still && front_faces) {
    throw input_error(
        "lidr: behind front faces, lights of a group must not touch on the screen, which depends on the "
        "camera; use lidr-sort=view, or lidr-volumes=stencil");
  }
  if (settings[setting::lidr_light_block] && plan.lights.planned == PlannedLights::in_view &&
      plan.lights.local.size() > LIGHTS_OF_BLOCK) {
    throw input_error(
        "lidr: a uniform block holds {} lights, but {} are in view; use lidr-light-data=textures",
        LIGHTS_OF_BLOCK, plan.lights.local.size());
  }
  if (settings[setting::lidr_volumes] == LidrVolumes::no_prepass &&
      (plan.shadows.light_reaches || plan.shadows.own)) {
    throw input_error(
        "lidr: shadows are found at the surfaces of a depth prepass; use lidr-volumes=front-faces, or "
        "shadows=none");
  }
}

static Frame render(RenderView& v) {
  refuse_impossible(v.plan);
  const bool prepass =
      v.plan.settings[setting::lidr_volumes] != LidrVolumes::no_prepass || v.plan.lights.local.empty();
  const Surfaces surfaces =
      prepass ? find_surfaces(v) : Surfaces{.image = no_depth_yet(v), .drawn = v.opaque};
  if (v.plan.lights.local.empty()) return shade_every_light(v, surfaces);
  const uint32_t passes = order_light_index(v, v.caches.light_index, v.caches.light_volumes);
  const auto lights_of = [&](uint32_t pass) {
    return light_index(v, v.caches.light_index, v.caches.light_volumes, v.caches.index_shadows,
                       surfaces.numbered, pass);
  };
  const LightSource lights = lights_of(0);
  const ShadedImage image =
      prepass ? shade_forward(v, surfaces.drawn, lights) : shade_forward_and_depth(v, surfaces.drawn, lights);
  for (uint32_t pass = 1; pass < passes; ++pass)
    add_lights_forward(v, surfaces.drawn, lights_of(pass), image);
  // Stencil marks opaque surfaces only, and only from these are lights hidden.
  const bool as_opaque =
      !v.plan.shadows.own || v.plan.settings[setting::lidr_shadows] == LidrShadows::final_pass;
  // A blended surface takes all its lights at once, and images have those of one pass.
  if (v.plan.settings[setting::lidr_volumes] != LidrVolumes::stencil && as_opaque && passes == 1) {
    blend(v, surfaces, lights, image);
  } else {
    shade_blended(v, image, find_blended_object_lights(v, v.caches.blended_object_lights));
  }
  Frame frame{.image = image, .listed = lights.listed, .list_bytes = lights.bytes};
  tell_index_shadows(v, v.caches.index_shadows, v.caches.light_volumes, frame);
  return frame;
}

static const Setting<int> lights_with_maps{
    390,
    "lidr-maps",
    "lights with shadow maps, with lidr-shadows=final: the most important",
    {{"4", 4}, {"1", 1}, {"16", 16}, {"64", 64}, {"256", 256}},
    {.shown = [](const Settings& s) { return s[setting::lidr_shadows] == LidrShadows::final_pass; }}};

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  needs.surfaces.reversed_triangles =
      settings[setting::lidr_passes] > 1 || settings[setting::lidr_types] == LidrTypes::passes;
  needs.lists.light_block = settings[setting::lidr_light_block];
  const LidrShadows way = settings[setting::lidr_shadows];
  if (way == LidrShadows::pass) return;
  needs.shadows.own = true;
  needs.shadows.found_by = way == LidrShadows::volumes ? "shadow volumes" : "maps";
  if (way == LidrShadows::none) needs.shadows.max_own = 0;
  if (way == LidrShadows::final_pass) needs.shadows.max_own = size_t(settings[lights_with_maps]);
}

extern const Technique lidr{
    .name = "lidr",
    .summary = "light volumes drawn into images of light indices",
    .source = "Trebilco: Light-Indexed Deferred Rendering, ShaderX7 2.9, 2009",
    .needs = {.effects = all_effects, .surfaces = {.stencil = true}, .samples = {.most = 8}, .adapt = adapt},
    .settings = {"brdf",         "lidr-packing",  "lidr-overlap",    "lidr-lights",
                 "lidr-volumes", "lidr-unpack",   "lidr-types",      "lidr-sort",
                 "lidr-passes",  "lidr-order",    "lidr-light-data", "lidr-shadows",
                 "lidr-maps",    "volume-mesh",   "depth-bounds",    "tile",
                 "samples",      "samples-masks", "samples-resolve", "kernel-shape"},
    .render = render,
    .listed_by = ListedBy::pixel,
    .limited_lists = true};

}  // namespace lightgrid
