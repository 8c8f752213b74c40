// Light pre-pass: depth and normals, then the sums of all lights a pixel, then each surface's material under
// its pixel's sums (docs/techniques/light_prepass.md).
#include "base/error.h"
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/draw_light_buffer.h"
#include "passes/fill_light_buffer.h"
#include "passes/fill_normals.h"
#include "passes/find_object_lights.h"
#include "passes/resolve.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "passes/shade_light_volumes.h"
#include "techniques/technique.h"

namespace lightgrid {

static Frame without_lights(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, depth_bounds(v, depth)));
  const ShadedImage image = shade_forward(v, surfaces, every_light(v));
  shade_blended(v, image, every_light(v));
  return {image};
}

static Frame from_volumes(RenderView& v) {
  const NormalImage normals = fill_normals(v);
  const LightBuffer lights = draw_light_buffer(v, normals);
  const ShadedImage image = shade_forward(v, v.opaque, from_light_buffer(v, lights));
  shade_blended(v, image, find_blended_object_lights(v));
  return {image};
}

static Frame from_tiles(RenderView& v) {
  Frame frame;
  const NormalImage normals = fill_normals(v);
  const DepthBuffer depth = depth_to_cl(v, normals.depth);
  const DepthBounds bounds = depth_bounds(v, depth);
  const DrawList surfaces = visible_surfaces(v, tile_distances(v, bounds));
  const NormalsInCl in_cl = normals_to_cl(v, normals);
  frame.grid = cull_lights(v, bounds);
  const LightBufferInCl sums = fill_light_buffer(v, in_cl, depth, *frame.grid, TargetUse::image);
  frame.image = shade_forward(v, surfaces, from_light_buffer(v, light_buffer_to_gl(v, sums)));
  shade_blended_from_grid(v, bounds, frame);
  return frame;
}

static Frame in_cl(RenderView& v) {
  if (v.plan.settings.prepass_lights == PrepassLights::volumes)
    throw input_error(
        "light_prepass: OpenGL draws light volumes, so prepass-lights=volumes needs raster=opengl");
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = visible.triangles();
  DepthBounds bounds;
  if (v.plan.light_grid) {
    const NormalsInCl normals = resolve_normals(v, visible);
    bounds = depth_bounds(v, *frame.depth);
    frame.grid = cull_lights(v, bounds);
    frame.image = resolve_materials(
        v, visible, fill_light_buffer(v, normals, *frame.depth, *frame.grid, TargetUse::gbuffer));
  } else {
    frame.image = resolve(v, visible, {});
  }
  blend_resolved_from_grid(v, bounds, frame);
  return frame;
}

static Frame render(RenderView& v) {
  if (v.plan.settings.raster == RasterApi::opencl) return in_cl(v);
  if (!v.plan.local_lights) return without_lights(v);
  return v.plan.settings.prepass_lights == PrepassLights::volumes ? from_volumes(v) : from_tiles(v);
}

extern const Technique light_prepass{
    .name = "light_prepass",
    .summary = "depth and normals, then a buffer of light, then materials",
    .source = "Engel: Designing a Renderer for Multiple Lights: The Light Pre-Pass Renderer, ShaderX7, 2009",
    .needs =
        {.light_grid = true, .lists = true, .z_bins = true, .prepass_lights = true, .chosen_raster = true},
    .settings = {"brdf", "prepass-lights", "prepass-specular", "prepass-shininess", "buffer-bits", "normals",
                 "volume-culling", "volume-mesh", "cull-test", "depth-bounds", "tile", "slice-spacing",
                 "z-bins", "raster", "texels", "kernel-shape", "portable", "group-size"},
    .render = render,
    .listed = listed_of_light_volumes,
    .approximate = true};

}  // namespace lightgrid
