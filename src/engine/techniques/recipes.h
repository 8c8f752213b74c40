// The frames that several techniques share.
#pragma once

#include "plan/settings/masks.h"
#include "techniques/technique.h"

namespace lightgrid {

// The grid of opaque surfaces, its lists no longer than the setting list-cap.
ViewGrid list_lights(RenderView& v, Surfaces& surfaces);

// From a light grid, of forward_plus, clustered and visibility: surfaces, depth bounds, cull, shade, blended
// surfaces. The plan's slices, and who draws surfaces, make the difference.
Frame shade_from_light_grid(RenderView& v);

// The frame without lists.
Frame shade_every_light(RenderView& v, const Surfaces& surfaces);

// Blends blended surfaces over the frame's image, whose opaque ones have the lights of a grid. With depth
// bounds, they get a grid of their own, stored in the frame; without, they use that of opaque surfaces, whose
// lists become the frame's.
void blend_from_grid(RenderView& v, Surfaces& surfaces, const LightSource& opaque, Frame& frame);

// deferred_tiled and forward_plus_compute, which with OpenGL find depth differently, share these: surfaces
// into a geometry buffer; then OpenCL adds the lights of each tile's list to its image, and blended surfaces
// are laid over it. Without `surfaces`, OpenGL finds depth while it fills the geometry buffer.
Frame shade_tiled(RenderView& v, std::optional<Surfaces> surfaces);
void adapt_shade_tiled(TechniqueNeeds& needs, Settings& settings);  // samples' light is averaged as it is
inline const TechniqueNeeds needs_of_shade_tiled{
    .effects = all_effects,
    .surfaces = {.chosen_raster = true, .stored = true},
    .lists = {.light_grid = true, .z_bins = true, .no_masks = true, .capped = true, .sampled = true},
    .masks = {.tiles = true},
    .samples = {.most = 8},
    .adapt = adapt_shade_tiled};
inline const std::vector<const char*> settings_of_shade_tiled = {"brdf",
                                                                 "buffer-bits",
                                                                 setting::number_bits_key,
                                                                 setting::tile_masks_key,
                                                                 "cull-test",
                                                                 "depth-bounds",
                                                                 "tile",
                                                                 "slice-spacing",
                                                                 "z-bins",
                                                                 "list-cap",
                                                                 "list-cap-order",
                                                                 "list-seed",
                                                                 "view-cap",
                                                                 "raster",
                                                                 "samples",
                                                                 "samples-masks",
                                                                 "samples-shading",
                                                                 "texels",
                                                                 "kernel-shape",
                                                                 "portable",
                                                                 "group-size"};

// forward_multipass and forward_zprepass share this: each object with the lights that reach its visible part,
// `lights_a_draw` in each draw, added up; then blended surfaces. own_apart: the first draw has base lighting
// alone.
Frame shade_by_objects(RenderView& v, uint32_t lights_a_draw, bool own_apart);

}  // namespace lightgrid
