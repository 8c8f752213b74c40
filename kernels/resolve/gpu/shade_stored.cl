// Point and spot lights of every tile's list on surfaces that images store, for GPUs: a work-item takes a
// pixel, sample after sample. As resolve/cpu/shade_stored.cl, with the same arguments.
#define LANES 1
#include "kernels/resolve/stored.h"
#include "shared/light_grid.h"

kernel void shade_stored(STORED_LIST(PARAMETER) global const float* depth,
                         SURFACE_NUMBER_ARGUMENTS LIGHT_ARGUMENTS global const uint2* cells,
                         global const index_t* indices, global const uint* light_bins,
                         FACTOR_ARGUMENTS constant float* bin_edges, global const ushort* edges,
                         constant ViewParams* view) {
  const uint x = get_global_id(0), y = get_global_id(1);
  if (x >= view->width || y >= view->height) return;
  const uint2 range = cells[cell_of_pixel(x, y, view->tile_size, view->tiles_x)];
  if (range.y == 0 && !NEEDS_EVERY_PIXEL) return;
  const bool edge = at_edge(edges, (size_t)y * view->width + x);
  const Stored stored = {STORED_LIST(GIVEN)};
  Lights lights = {GIVEN_LIGHTS light_bins GIVEN_FACTORS(indices) GIVEN_SHADOWS};
  light_pixels(&lights, x, y, view);
  for (uint s = 0; s < (edge ? SAMPLES : 1); ++s) {
    const StoredBatch b = stored_sample(depth, x, y, view->width, s, edge);
    const SurfaceValues surface = VALUES_OF_BATCH(&b);
    shade(&stored, &b, surface, indices + range.x, range.y, bin_edges, &lights, view);
  }
}
