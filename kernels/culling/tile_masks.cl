// The masks of each tile's surfaces together: the OR of their masks. A work-item takes a tile.
//
// triangles, triangle_instance, surfaces  -DTRIANGLES: numbers of triangles, SAMPLES a pixel, and what they
//            lead to (shared/surface_records.h)
// numbers, depths  else: numbers of masks (kernels/resolve/surface_numbers.h) and depth, a pixel each; depth
// 0
//            means no surface
// masks, last  by number, and the last number
// tile_masks  a word a tile, in the order of depth bounds: bins, and their slots
// width, height, tile, bins_x  pixels; of tiles; bins in a row
#define LANES 1
#include "shared/light_grid.h"
#include "shared/surface_records.h"
#ifndef TRIANGLES
#ifndef NUMBER_BITS
#define NUMBER_BITS 8
#endif
#include "kernels/resolve/surface_numbers.h"
#endif
#ifndef SAMPLES
#define SAMPLES 1u
#endif

#ifdef TRIANGLES
#define NUMBERS(at) vload16(0, triangles + (at))
#else
#define NUMBERS(at) convert_uint16(vload16(0, numbers + (at)))
#endif

kernel void tile_masks(
#ifdef TRIANGLES
    global const uint* triangles, global const uint* triangle_instance,
    global const SurfaceInstance* surfaces,
#else
    global const surface_number_t* numbers, global const float* depths,
#endif
    global const uint* masks, uint last, global uint* tile_masks, uint width, uint height, uint tile,
    uint bins_x) {
  const uint bin = get_global_id(0) / BIN_SIZE, slot = get_global_id(0) % BIN_SIZE;
  const uint x0 = (bin % bins_x * BIN_TILES + tile_x_of_slot(slot)) * tile;
  const uint y0 = (bin / bins_x * BIN_TILES + tile_y_of_slot(slot)) * tile;
  const uint first = x0 * SAMPLES, end = min(x0 + tile, width) * SAMPLES;
  uint found = 0;
  uint before = SURFACE_NONE;  // neighbours mostly are of one triangle, or of one number
  for (uint y = y0; y < min(y0 + tile, height); ++y) {
    for (uint x = first; x < end; ++x) {
      const size_t at = (size_t)y * width * SAMPLES + x;
      if ((x - first) % 16 == 0 && x + 16 <= end && all(NUMBERS(at) == (uint16)(before))) {
        x += 15;
        continue;
      }
#ifdef TRIANGLES
      const uint here = triangles[at];
      if (here == before || here == SURFACE_NONE) continue;
      const uint number = surfaces[triangle_instance[here]].flags >> INSTANCE_NUMBER_SHIFT;
#else
      const uint here = numbers[at], number = here;
      if (here == before || !(depths[at] > 0.0f)) continue;
#endif
      before = here;
      found |= masks[min(number, last)];
    }
  }
  tile_masks[get_global_id(0)] = found;
}
