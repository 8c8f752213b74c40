// Lights are added up at the samples of a volume; surfaces read the volume, however many lights there are.
#include "passes/build_voxels.h"
#include "passes/cull_lights.h"
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/resolve.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {
namespace {

// Without voxel-lights-exact there is no grid.
void cull_exact(RenderView& v, const DepthBounds& bounds, Frame& frame) {
  if (!v.plan.light_grid) return;
  frame.grid = cull_lights(v, bounds);
  if (v.plan.blend_grid) frame.blend_grid = cull_lights_for_blended(v, bounds);
}

GridTextures textures_of(RenderView& v, const std::optional<LightGrid>& grid, bool blended) {
  return grid ? grid_to_gl(v, *grid, blended ? v.blend_grid() : v.opaque_grid()) : GridTextures();
}

Frame with_opengl(RenderView& v) {
  Frame frame;
  const DepthImage depth = depth_prepass(v);
  const DepthBounds bounds = depth_bounds(v, depth);
  const TileDistances distances = tile_distances(v, bounds);
  LightSource lights = every_light(v), blended = lights;
  if (v.plan.local_lights) {
    cull_exact(v, bounds, frame);
    const VoxelTextures voxels = voxels_to_gl(v, build_voxels(v, distances));
    lights = from_voxels(v, voxels, textures_of(v, frame.grid, false));
    blended = frame.blend_grid ? from_voxels(v, voxels, textures_of(v, frame.blend_grid, true)) : lights;
  }
  frame.image = shade_forward(v, visible_surfaces(v, distances), lights);
  shade_blended(v, frame.image, blended);
  return frame;
}

Frame with_opencl(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = visible.triangles();
  GridInCl lights, blended;
  VoxelVolume voxels;
  if (v.plan.local_lights) {
    const DepthBounds bounds = depth_bounds(v, *frame.depth);
    cull_exact(v, bounds, frame);
    voxels = build_voxels(v, tile_distances(v, bounds), *frame.depth);
    lights.voxels = &voxels;
    if (frame.grid) lights.grid = &*frame.grid, lights.storage = &v.opaque_grid();
    blended = lights;
    if (frame.blend_grid) blended.grid = &*frame.blend_grid, blended.storage = &v.blend_grid();
  }
  frame.image = resolve(v, visible, lights);
  if (!v.plan.blended.empty()) blend_resolved(v, list_blended(v), *frame.depth, blended);
  return frame;
}

}  // namespace

static Frame render(RenderView& v) {
  return v.plan.settings.raster == RasterApi::opencl ? with_opencl(v) : with_opengl(v);
}

extern const Technique voxel_lights{
    .name = "voxel_lights",
    .summary = "a volume of irradiance and mean directions: lights cost by the sample, not by the pixel",
    .source = "Geldreich: Light Indexed Deferred Rendering, on Halo Wars, 2009",
    .needs = {.light_grid = true, .lists = true, .chosen_raster = true, .exact_lights = true},
    .settings = {"brdf", "voxel-size", "voxel-space", "voxel-bits", "voxel-lights-exact", "voxel-reuse",
                 "cull-test", "depth-bounds", "tile", "raster", "texels", "kernel-shape", "portable",
                 "group-size"},
    .render = render,
    .listed = listed_of_voxels,
    .approximate = true};

}  // namespace lightgrid
