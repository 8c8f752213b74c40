// Blended surfaces laid over an image in drawing order, for CPUs: a work-item takes a tile of 64 x 64 pixels,
// record after record, and of each the blocks of 4 x 4 pixels that it covers in front of the opaque surfaces.
//
// records, tile_begin, lists  RasterView::list(): triangles of each tile, in drawing order
// tiles_x     of these tiles
// depths      of opaque surfaces, a pixel or sample each, reversed; row 0 at the bottom
// RESOLVE_ARGUMENTS  kernels/resolve/resolve_light.h; the grid is that of blended surfaces
// shadow_layers  with -DSHADOWS: layers of shadows, in the order of a pixel's fragments
// image       in and out: RGBA per pixel, linear, row 0 at the bottom
// -DTILE      of the light grid, pixels a side, a multiple of 8 (default 16)
// -DORTHOGRAPHIC, and what kernels/resolve/resolve.h and resolve_light.h name
#define BLEND  // shared/light_table.h
#define FUSED  // shared/real.h
#define LANES 16
#include "kernels/common/image_blocks.h"
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/resolve/blended_fragments.h"
#include "kernels/resolve/resolve_light.h"

#ifndef TILE
#define TILE 16
#endif

static inline void blend_block(global float* image, Real3 color, real alpha, mask_t shown, uint x, uint y,
                               uint width) {
  for (uint bits = mask_bits(shown); bits != 0; bits &= bits - 1) {
    const uint i = lowest_bit(bits);
    const size_t at = (size_t)(y + i / 4) * width + x + i % 4;
    const float a = LANE(alpha, i);
    const float4 over = (float4)(LANE(color.x, i), LANE(color.y, i), LANE(color.z, i), 1.0f);
    vstore4(blended(over, a, vload4(at, image)), at, image);
  }
}

#ifdef SHADOWS
#define LAYERS_ARGUMENT uint shadow_layers,
#else
#define LAYERS_ARGUMENT
#endif

kernel ONE_ITEM void blend(global const RasterRecord* records, global const uint* tile_begin,
                           global const uint* lists, uint tiles_x, global const float* depths,
                           LAYERS_ARGUMENT RESOLVE_ARGUMENTS, global float* image) {
  ASSUME_ONE_ITEM;
  const uint number = get_global_id(0), width = view->width, height = view->height;
  const uint tile_x = number % tiles_x * RASTER_TILE, tile_y = number / tiles_x * RASTER_TILE;
  const ResolveScene scene = RESOLVE_SCENE;
  ResolveLights lights = RESOLVE_LIGHTS;
#ifdef SHADOWS
  FragmentCounts counts = {0};
#endif
  for (uint i = tile_begin[number]; i < tile_begin[number + 1]; ++i) {
    global const RasterRecord* record = records + lists[i];
    const TileRecord r = in_tile(record, (int)tile_x, (int)tile_y);
    const PixelBox box = box_in_tile(record, (int)tile_x, (int)tile_y);
    for (int by = box.y0 & ~3; by <= box.y1; by += 4) {
      for (int bx = box.x0 & ~3; bx <= box.x1; bx += 4) {
        const uint x = tile_x + (uint)bx, y = tile_y + (uint)by;
        real depth = REAL(0.0f);
#if SAMPLES > 1
        real share = REAL(1.0f);
#endif
        mask_t shown = fragments_in_block(&r, bx, by, x, y, depths, width, height, &depth SHARE_TO(share));
        if (!any_lane(shown)) continue;
#ifdef SHADOWS
        light_pixels(&lights.lights, x, y, view);
        light_layers(&lights.lights, next_layers(&counts, bx, by, shown), shown, shadow_layers);
#endif
        Attributes a = {0};
        Surface s = {0};
        add_triangle(&a, &scene, r.triangle, shown, (float)x, (float)y, BLOCK_DX, BLOCK_DY);
        add_material(&s, &a, &scene, scene.surfaces[r.instance].material, shown);
        shown &= s.alpha != REAL(0.0f);  // shows nothing
        if (!any_lane(shown)) continue;
        take_list(&lights, light_indices, cells, y / TILE * view->tiles_x + x / TILE, view);
        const Resolved resolved = resolved_at(&a, &s, x, y, depth, shown);
        const Real3 color = radiance(&resolved, &lights, bin_edges, view);
#if SAMPLES > 1
        s.alpha *= share;
#endif
        blend_block(image, color, s.alpha, shown, x, y, width);
      }
    }
  }
}
