// Lights are added up at the samples of a volume; surfaces read the volume, however many lights there are.
#include "passes/build_voxels.h"
#include "passes/cull_lights.h"
#include "passes/voxels/voxel_settings.h"
#include "techniques/recipes.h"

namespace lightgrid {

static Frame render(RenderView& v) {
  Surfaces surfaces = find_surfaces(v);
  if (!v.plan.lights.any_local) return shade_every_light(v, surfaces);
  Frame frame = frame_of(v, surfaces);
  std::optional<LightSource> exact, exact_blended;  // without voxel-lights-exact there is no grid
  if (v.plan.lists.light_grid) {
    const DepthBounds& bounds = bounds_of(v, surfaces);
    exact = from_grid(v, frame.grid.emplace(cull_lights(v, v.culler(), v.opaque_grid(), bounds)));
    if (v.plan.lists.blend_grid)
      exact_blended = from_grid(
          v, frame.blend_grid.emplace(cull_lights_for_blended(v, v.culler(), v.blend_grid(), bounds)));
  }
  const TileDistances& distances = distances_of(v, surfaces);
  const VoxelVolume voxels = build_voxels(v, v.caches.voxels, distances,
                                          surfaces.visible ? surfaces.visible->pixel_depth() : DepthBuffer());
  const LightSource lights = from_voxels(v, v.caches.voxels, voxels, exact ? &*exact : nullptr);
  frame.listed = exact ? exact->listed : lights.listed;
  frame.lights_in_volume = true;
  frame.image = shade(v, surfaces, lights);
  blend(v, surfaces, exact_blended ? from_voxels(v, v.caches.voxels, voxels, &*exact_blended) : lights,
        frame.image);
  return frame;
}

static void adapt(TechniqueNeeds& needs, Settings& settings) {
  if (settings[setting::voxel_lights_exact] != 0) return;
  needs.lists.light_grid = false;
  needs.lists.no_light_grid = "voxel-lights-exact=0";
  needs.shadows.asked_for = false;
  needs.shadows.why_none = "lights are added up where no pixel asks for one";
}

extern const Technique voxel_lights{
    .name = "voxel_lights",
    .summary = "a volume of irradiance and mean directions: lights cost by the sample, not by the pixel",
    .source = "Geldreich: Light Indexed Deferred Rendering, on Halo Wars, 2009",
    .needs = {.effects = all_effects,
              .surfaces = {.chosen_raster = true},
              .lists = {.light_grid = true, .no_masks = true},
              .masks = {.of = "; of directional and exact lights alone: the volume's light belongs to no "
                              "surface"},
              .samples = {.most = 8},
              .adapt = adapt},
    .settings = {"brdf", "voxel-size", "voxel-space", "voxel-bits", "voxel-lights-exact", "voxel-reuse",
                 "cull-test", "depth-bounds", "tile", "raster", "samples", "samples-masks", "samples-resolve",
                 "texels", "kernel-shape", "portable", "group-size"},
    .render = render,
    .listed_by = ListedBy::pixel,
    .approximate = true};

}  // namespace lightgrid
