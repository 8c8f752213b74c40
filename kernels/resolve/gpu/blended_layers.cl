// The fragments of blended surfaces in layers, for GPUs: a work-item a pixel. As
// resolve/cpu/blended_layers.cl, with the same arguments, but `most` is 0 before: each pixel clears the rest
// of its layers.
#define LANES 1
#include "kernels/resolve/blended_fragments.h"
#include "shared/shadow_bits.h"
#include "shared/view_params.h"

kernel void blended_layers(global const RasterRecord* records, global const uint* tile_begin,
                           global const uint* lists, uint tiles_x, global const float* depths, uint capacity,
                           constant ViewParams* view, global uint* layers, global uint* most) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint number = y / RASTER_TILE * tiles_x + x / RASTER_TILE;
  const int tile_x = (int)(x / RASTER_TILE * RASTER_TILE), tile_y = (int)(y / RASTER_TILE * RASTER_TILE);
  const int dx = (int)(x & 3u), dy = (int)(y & 3u), bx = (int)x - tile_x - dx, by = (int)y - tile_y - dy;
  const size_t pixel = (size_t)y * view->width + x, stride = LAYER_STRIDE((size_t)view->width * view->height);
  const OpaqueDepth opaque = OPAQUE_DEPTH(depths, pixel);
#if SAMPLES > 1
  float share;
#endif
  uint layer = 0;
  for (uint i = tile_begin[number]; i < tile_begin[number + 1]; ++i) {
    const TileRecord r = in_tile(records + lists[i], tile_x, tile_y);
    float depth;
    if (!is_fragment(&r, bx, by, dx, dy, opaque, &depth SHARE_TO(share))) continue;
    if (layer < capacity) {
      layers[layer * stride + pixel] = r.triangle;
      layers[(capacity + layer) * stride + pixel] = as_uint(depth);
    }
    ++layer;
  }
  if (layer != 0) atomic_max(most + number, layer);
  for (; layer < capacity; ++layer) {
    layers[layer * stride + pixel] = SHADOW_NO_TRIANGLE;
    layers[(capacity + layer) * stride + pixel] = 0;
  }
}
