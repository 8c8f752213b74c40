// Point and spot lights of every tile's list on surfaces that images store, for CPUs: a work-item takes a
// tile, LANES surfaces at a time (kernels/resolve/stored_batch.h).
//
// STORED_LIST     images in and out: kernels/resolve/stored.h
// depth           reversed depth of each sample, row 0 at the bottom
// SURFACE_NUMBER_ARGUMENTS  kernels/resolve/surface_numbers.h, only with -DNUMBER_BITS
// LIGHT_ARGUMENTS  of lights (shared/light_table.h)
// cells, indices  light grid (shared/light_grid.h)
// light_bins, bin_edges  z-bins of each light, and the depth keys between them (shared/slices.h),
//                 only with -DZ_BINS
// FACTOR_ARGUMENTS  kernels/resolve/shade_pixels.h, only with -DLIST_FACTORS
// edges           pixels whose samples are shaded apart (kernels/resolve/sample_edges.h); null: all pixels
// -DTILE          pixels a side, a multiple of 8 (default 16)
// -DSTORED_…, and what kernels/resolve/shade_pixels.h and stored_batch.h name
#define LANES 16
#ifndef TILE
#define TILE 16
#endif
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/resolve/stored.h"

kernel ONE_ITEM void shade_stored(STORED_LIST(PARAMETER) global const float* depth,
                                  SURFACE_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                                  global const index_t* indices, global const uint* light_bins,
                                  FACTOR_ARGUMENTS constant float* bin_edges, global const ushort* edges,
                                  constant ViewParams* view) {
  ASSUME_ONE_ITEM;
  const uint tile_x = get_global_id(0), tile_y = get_global_id(1);
  const uint2 range = cells[tile_y * view->tiles_x + tile_x];
  if (range.y == 0 && !NEEDS_EVERY_PIXEL) return;
  const Stored stored = {STORED_LIST(GIVEN)};
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
  StoredWalk walk = {tile_x * TILE,
                     min(tile_x * TILE + TILE, view->width),
                     min(tile_y * TILE + TILE, view->height),
                     tile_x * TILE,
                     tile_y * TILE,
                     0};
  StoredBatch b;
  while (next_batch(&b, &walk, depth, edges, view->width, view->height)) {
    light_pixels(&lights, (uint)b.x.s0, (uint)b.y.s0, view);
    const SurfaceValues surface = VALUES_OF_BATCH(&b);
    shade(&stored, &b, surface, indices + range.x, range.y, bin_edges, &lights, view);
  }
}
