// The fragments of blended surfaces in layers, of which each has shadows of its own, for CPUs: a work-item
// takes a tile of 64 x 64 pixels. A pixel's fragments are in drawing order, as kernels/resolve/cpu/blend.cl
// counts them.
//
// records, tile_begin, lists, tiles_x, depths  as blend.cl has them
// capacity  layers that there is room for; fragments past them are only counted
// layers    in and out: of each layer LAYER_STRIDE values (shared/shadow_bits.h): triangles by the
//           rasteriser's numbers, then of each as many reversed depths. Before, the last frame's
// most      in and out: the most fragments of a pixel, a tile. Before, those of the last frame
#define LANES 16
#include "kernels/common/image_blocks.h"
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/resolve/blended_fragments.h"
#include "shared/shadow_bits.h"
#include "shared/view_params.h"

// Most tiles have no fragments: only the layers that the last frame wrote to are cleared.
static inline void clear_tile(global uint* numbers, global uint* depths, uint x0, uint y0, uint width,
                              uint height) {
  const uint x1 = min(x0 + RASTER_TILE, width);
  for (uint y = y0; y < min(y0 + RASTER_TILE, height); ++y)
    for (uint x = x0; x < x1; ++x) {
      numbers[(size_t)y * width + x] = SHADOW_NO_TRIANGLE;
      depths[(size_t)y * width + x] = 0;
    }
}

kernel ONE_ITEM void blended_layers(global const RasterRecord* records, global const uint* tile_begin,
                                    global const uint* lists, uint tiles_x, global const float* depths,
                                    uint capacity, constant ViewParams* view, global uint* layers,
                                    global uint* most) {
  ASSUME_ONE_ITEM;
  const uint number = get_global_id(0), width = view->width, height = view->height;
  const uint tile_x = number % tiles_x * RASTER_TILE, tile_y = number / tiles_x * RASTER_TILE;
  const size_t stride = LAYER_STRIDE((size_t)width * height);
  for (uint layer = 0; layer < min(most[number], capacity); ++layer)
    clear_tile(layers + layer * stride, layers + (capacity + layer) * stride, tile_x, tile_y, width, height);
  FragmentCounts counts = {0};
  uint greatest = 0;
  for (uint i = tile_begin[number]; i < tile_begin[number + 1]; ++i) {
    global const RasterRecord* record = records + lists[i];
    const TileRecord r = in_tile(record, (int)tile_x, (int)tile_y);
    const PixelBox box = box_in_tile(record, (int)tile_x, (int)tile_y);
    for (int by = box.y0 & ~3; by <= box.y1; by += 4) {
      for (int bx = box.x0 & ~3; bx <= box.x1; bx += 4) {
        const uint x = tile_x + (uint)bx, y = tile_y + (uint)by;
        real depth = REAL(0.0f);
#if SAMPLES > 1
        real share;
#endif
        const mask_t shown =
            fragments_in_block(&r, bx, by, x, y, depths, width, height, &depth SHARE_TO(share));
        if (!any_lane(shown)) continue;
        const whole of_layers = next_layers(&counts, bx, by, shown);
        for (uint left = mask_bits(shown); left != 0; left &= left - 1) {
          const uint lane = lowest_bit(left), layer = (uint)((const int*)&of_layers)[lane];
          greatest = max(greatest, layer + 1);
          if (layer >= capacity) continue;
          const size_t at = layer * stride + (size_t)(y + lane / 4) * width + x + lane % 4;
          layers[at] = r.triangle;
          layers[capacity * stride + at] = as_uint(((const float*)&depth)[lane]);
        }
      }
    }
  }
  most[number] = greatest;
}
