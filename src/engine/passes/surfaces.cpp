#include "passes/surfaces.h"

#include "passes/depth_bounds.h"
#include "passes/depth_prepass.h"
#include "passes/fill_gbuffer.h"
#include "passes/find_shadows.h"
#include "passes/resolve.h"
#include "passes/shade_forward.h"
#include "passes/tile_masks.h"
#include "plan/settings/grid.h"

namespace lightgrid {

static Surfaces draw_with_numbers(RenderView& v, bool depth_in_cl) {
  const GLuint numbers = surface_number_image(v);
  const DepthImage depth = depth_prepass(v, numbers);
  SharedBuffer& in_cl =
      surface_numbers_to_cl(v, v.targets.framebuffer({numbers}, v.targets.depth()), 0, numbers);
  Surfaces surfaces = surfaces_of(v, depth, depth_in_cl);
  surfaces.surface_numbers = &in_cl;
  return surfaces;
}

Surfaces find_surfaces(RenderView& v, bool depth_in_cl, bool with_numbers) {
  if (v.plan.opengl && with_numbers && v.plan.masks.tiles) return draw_with_numbers(v, depth_in_cl);
  if (v.plan.opengl) return surfaces_of(v, depth_prepass(v), depth_in_cl);
  Surfaces surfaces{.visible = rasterize(v, v.caches)};
  surfaces.depth = surfaces.visible->depth();
  find_shadows(v, surfaces);
  return surfaces;
}

Surfaces surfaces_of(RenderView& v, const DepthImage& image, bool depth_in_cl) {
  Surfaces surfaces{.image = image};
  if (depth_in_cl) depth_of(v, surfaces);
  find_shadows(v, surfaces);
  surfaces.drawn = visible_surfaces(v, distances_of(v, surfaces));
  return surfaces;
}

void find_shadows(RenderView& v, Surfaces& surfaces) {
  if (!v.plan.shadows.light_reaches || shadows_are_unchanged(v, v.caches.shadow_bits)) return;
  if (v.plan.shadows.needed && surfaces.visible && !v.plan.surfaces.blended.empty())
    surfaces.blended = list_blended(v, v.caches.blended_triangles);
  find_shadows(v, v.caches, surfaces.visible ? &*surfaces.visible : nullptr,
               v.plan.shadows.needed ? depth_of(v, surfaces) : DepthBuffer(),
               surfaces.blended ? &*surfaces.blended : nullptr);
  surfaces.numbered = v.plan.shadows.needed && v.plan.opengl;
}

const DepthBuffer& depth_of(RenderView& v, Surfaces& surfaces) {
  if (!surfaces.depth.values()) surfaces.depth = depth_to_cl(v, surfaces.image);
  return surfaces.depth;
}

const DepthBounds& bounds_of(RenderView& v, Surfaces& surfaces) {
  if (surfaces.bounds) return *surfaces.bounds;
  const bool read = v.plan.settings[setting::depth_bounds] != DepthBoundsMode::none;
  return surfaces.bounds.emplace(depth_bounds(v, v.culler(), read ? depth_of(v, surfaces) : DepthBuffer()));
}

DepthBounds cull_bounds_of(RenderView& v, Surfaces& surfaces) {
  DepthBounds bounds = bounds_of(v, surfaces);
  if (!v.plan.masks.tiles) return bounds;
  const CullParams& tiles = v.culler().params();
  bounds.opaque.masks = surfaces.visible ? tile_masks(v, v.caches.tile_masks, tiles, *surfaces.visible)
                                         : tile_masks(v, v.caches.tile_masks, tiles,
                                                      *surfaces.surface_numbers, depth_of(v, surfaces));
  return bounds;
}

const TileDistances& distances_of(RenderView& v, Surfaces& surfaces) {
  if (surfaces.distances) return *surfaces.distances;
  return surfaces.distances.emplace(tile_distances(v, v.culler(), bounds_of(v, surfaces)));
}

// Without point and spot lights there is no light pass, and the image takes all.
static BaseLighting base_lighting_of(const RenderView& v) {
  return v.plan.lists.light_grid && !v.plan.surfaces.base_lighting ? BaseLighting::in_light_pass
                                                                   : BaseLighting::in_image;
}

GBuffer fill_gbuffer(RenderView& v, std::optional<Surfaces>& surfaces) {
  if (!surfaces && v.plan.shadows.directional) surfaces = find_surfaces(v);
  if (!surfaces) {
    const GBuffer gbuffer = fill_gbuffer(v, base_lighting_of(v));
    surfaces = Surfaces{.image = gbuffer.depth_image};
    find_shadows(v, *surfaces);
    return gbuffer;
  }
  if (!surfaces->visible) return fill_gbuffer(v, surfaces->drawn, base_lighting_of(v));
  GBuffer gbuffer;
  gbuffer.in_cl = resolve_gbuffer(v, v.caches.resolver, *surfaces->visible, base_lighting_of(v));
  return gbuffer;
}

void hand_over(RenderView& v, const GBuffer& gbuffer, Surfaces& surfaces) {
  if (gbuffer.surface_numbers)
    surfaces.surface_numbers =
        &surface_numbers_to_cl(v, gbuffer.framebuffer, gbuffer.number_attachment(), gbuffer.surface_numbers);
}

Frame frame_of(RenderView& v, const Surfaces& surfaces) {
  Frame frame;
  if (surfaces.visible) {
    frame.depth = surfaces.visible->pixel_depth();
    frame.triangles = surfaces.visible->triangles();
    if (surfaces.visible->pixels)
      frame.sample_figures = [&v, visible = *surfaces.visible] {
        return sample_figures(v, visible.image, *visible.pixels);
      };
  }
  return frame;
}

ShadedImage shade(RenderView& v, const Surfaces& surfaces, const LightSource& lights) {
  return surfaces.visible ? resolve(v, v.caches.resolver, *surfaces.visible, lights)
                          : shade_forward(v, surfaces.drawn, lights);
}

void blend(RenderView& v, const Surfaces& surfaces, const LightSource& lights, const ShadedImage& image) {
  if (!surfaces.visible) return shade_blended(v, image, lights);
  if (v.plan.surfaces.blended.empty()) return;
  const BlendedTriangles blended =
      surfaces.blended ? *surfaces.blended : list_blended(v, v.caches.blended_triangles);
  blend_resolved(v, v.caches.resolver, blended, surfaces.depth, lights);
}

}  // namespace lightgrid
