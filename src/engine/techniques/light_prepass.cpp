// Light pre-pass: depth and normals, then the sums of all lights a pixel, then each surface's material under
// its pixel's sums (docs/techniques/light_prepass.md).
#include "base/error.h"
#include "passes/cull_lights.h"
#include "passes/depth_prepass.h"
#include "passes/fill_light_buffer.h"
#include "passes/find_object_lights.h"
#include "passes/resolve.h"
#include "passes/sample_edges.h"
#include "passes/shade_forward.h"
#include "passes/shade_light_volumes.h"
#include "plan/settings/masks.h"
#include "plan/settings/surfaces.h"
#include "techniques/recipes.h"

namespace lightgrid {

enum class PrepassLights { tiles, volumes };

static const Setting<PrepassLights> prepass_lights{
    240,
    "prepass-lights",
    "how the light buffer is summed: by OpenCL from lists of tiles, or by OpenGL, one light volume after the "
    "other",
    {{"tiles", PrepassLights::tiles}, {"volumes", PrepassLights::volumes}}};

static Frame from_volumes(RenderView& v) {
  const NormalImage normals = fill_normals(v);
  Surfaces surfaces{.image = normals.depth};
  find_shadows(v, surfaces);
  const LightBuffer lights = draw_light_buffer(v, v.caches.light_volumes, normals);
  const ShadedImage image = shade_forward(v, v.opaque, from_light_buffer(v, lights));
  shade_blended(v, image, find_blended_object_lights(v, v.caches.blended_object_lights));
  return {.image = image, .listed = listed_of_light_volumes(v, v.caches.light_volumes)};
}

static ShadedImage shade_materials(RenderView& v, const Surfaces& surfaces, const LightBufferInCl& sums) {
  if (surfaces.visible) return resolve_materials(v, v.caches.resolver, *surfaces.visible, sums);
  return shade(v, surfaces, from_light_buffer(v, light_buffer_to_gl(v, sums)));
}

static Frame from_tiles(RenderView& v) {
  Surfaces surfaces;
  NormalsInCl normals;
  if (v.plan.opengl) {
    const NormalImage drawn = fill_normals(v);
    surfaces = surfaces_of(v, drawn.depth, true);
    normals = normals_to_cl(v, drawn);
    if (drawn.surface_numbers)
      normals.surface_numbers = surfaces.surface_numbers =
          &surface_numbers_to_cl(v, drawn.framebuffer, 1, drawn.surface_numbers);
  } else {
    surfaces = find_surfaces(v);
    normals = resolve_normals(v, v.caches.resolver, *surfaces.visible);
  }
  Frame frame = frame_of(v, surfaces);
  frame.grid = list_lights(v, surfaces);
  const LightSource lights = from_grid(v, *frame.grid);
  const TargetUse use = v.plan.opengl ? TargetUse::image : TargetUse::gbuffer;
  const DepthBuffer& depth = depth_of(v, surfaces);
  const size_t normal_bytes = normals.layout->image.bytes;
  const cl::Buffer edges = sample_edges(
      v, v.caches.sample_edges, {{normals.image}, normal_bytes, normals.surface_numbers, normals.edges},
      depth, normal_bytes + bytes_of_light_buffer(v.plan.settings) + surface_number_bytes(v.plan) + 4, frame);
  frame.image = shade_materials(
      v, surfaces, fill_light_buffer(v, v.caches.light_sums, normals, depth, lights, use, edges));
  blend_from_grid(v, surfaces, lights, frame);
  return frame;
}

static Frame render(RenderView& v) {
  const bool volumes = v.plan.settings[prepass_lights] == PrepassLights::volumes;
  if (volumes && !v.plan.opengl)
    throw input_error(
        "light_prepass: OpenGL draws light volumes, so prepass-lights=volumes needs raster=opengl");
  if (!v.plan.lights.any_local) return shade_every_light(v, find_surfaces(v));
  if (volumes && stores_luv(v.plan.settings))
    throw input_error(
        "light_prepass: hues cannot be added by blending, so light-buffer=luv needs prepass-lights=tiles");
  return volumes ? from_volumes(v) : from_tiles(v);
}

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  if (settings[prepass_lights] == PrepassLights::tiles) return;
  needs.lists.light_grid = needs.lists.capped = false;
  needs.lists.no_light_grid = "prepass-lights=volumes";
  needs.surfaces.stencil = settings[setting::volume_culling] == VolumeCulling::stencil;
  needs.masks.stencil = true;
}

extern const Technique light_prepass{
    .name = "light_prepass",
    .summary = "depth and normals, then a buffer of light, then materials",
    .source = "Engel: Designing a Renderer for Multiple Lights: The Light Pre-Pass Renderer, ShaderX7, 2009",
    .needs = {.effects = all_effects,
              .surfaces = {.chosen_raster = true, .stored = true},
              .lists = {.light_grid = true, .z_bins = true, .no_masks = true, .capped = true},
              .masks = {.tiles = true},
              .samples = {.most = 8},
              .adapt = adapt},
    .settings = {"brdf",
                 "prepass-lights",
                 "prepass-specular",
                 "prepass-shininess",
                 "light-buffer",
                 "buffer-bits",
                 "normals",
                 "volume-culling",
                 setting::number_bits_key,
                 setting::stencil_masks_key,
                 setting::tile_masks_key,
                 "volume-mesh",
                 "cull-test",
                 "depth-bounds",
                 "tile",
                 "slice-spacing",
                 "z-bins",
                 "list-cap",
                 "list-cap-order",
                 "view-cap",
                 "raster",
                 "samples",
                 "samples-masks",
                 "samples-resolve",
                 "samples-shading",
                 "texels",
                 "kernel-shape",
                 "portable",
                 "group-size"},
    .render = render,
    .listed_by = ListedBy::pixel,
    .approximate = true};

}  // namespace lightgrid
