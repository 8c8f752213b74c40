// Lights are added up at the samples of a volume; surfaces read the volume, however many lights there are.
#include "passes/build_voxels.h"
#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/resolve.h"
#include "passes/shade_blended.h"
#include "passes/shade_forward.h"
#include "techniques/technique.h"

namespace lightgrid {
namespace {

Frame with_opengl(RenderView& v) {
  const DepthImage depth = depth_prepass(v);
  const TileDistances distances = tile_distances(v, depth_bounds(v, depth));
  const LightSource lights =
      v.plan.local_lights ? from_voxels(v, voxels_to_gl(v, build_voxels(v, distances))) : every_light(v);
  const ShadedImage image = shade_forward(v, visible_surfaces(v, distances), lights);
  shade_blended(v, image, lights);
  return {image};
}

Frame with_opencl(RenderView& v) {
  Frame frame;
  const VisibilityBuffer visible = rasterize(v);
  frame.depth = visible.depth();
  frame.triangles = TriangleBuffer{visible.image.triangle};
  GridInCl lights;
  VoxelVolume voxels;
  if (v.plan.local_lights) {
    voxels = build_voxels(v, tile_distances(v, depth_bounds(v, *frame.depth)), *frame.depth);
    lights.voxels = &voxels;
  }
  frame.image = resolve(v, visible, lights);
  if (!v.plan.blended.empty()) blend_resolved(v, list_blended(v), *frame.depth, lights);
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
    .needs = {.chosen_raster = true},
    .settings = {"brdf", "voxel-size", "voxel-space", "voxel-bits", "voxel-reuse", "depth-bounds", "tile",
                 "raster", "texels", "kernel-shape", "portable"},
    .render = render,
    .listed = listed_of_voxels,
    .approximate = true};

}  // namespace lightgrid
