// Which tiles show the surfaces of the previous frame, at the same depths: a work-item takes a pixel.
//
// triangles, triangle_instance, number_offsets, depths  kernels/shadows/receivers.h
// is_known         0: `numbers` and `depth_bits` have no values yet
// numbers          in and out: per pixel the rays' number of its triangle, or NO_TRIANGLE
// depth_bits       in and out: the bits of `depths`
// same_receivers   in and out: per tile 1, here set to 0 if one of its pixels differs
#define LANES 1
#include "kernels/shadows/receivers.h"

kernel void same_receivers(global const uint* triangles, global const uint* triangle_instance,
                           global const int* number_offsets, global const uint* depths,
                           constant ViewParams* view, uint is_known, global uint* numbers,
                           global uint* depth_bits, global volatile uint* same_receivers) {
  const uint x = (uint)get_global_id(0), y = (uint)get_global_id(1), width = view->width;
  if (x >= width || y >= view->height) return;
  const size_t at = (size_t)y * width + x;
  const uint triangle = triangles[at], depth = depths[at];
  const uint number =
      triangle == NO_TRIANGLE ? NO_TRIANGLE : ray_number(triangle, triangle_instance, number_offsets);
  if (is_known != 0 && numbers[at] == number && depth_bits[at] == depth) return;
  numbers[at] = number;
  depth_bits[at] = depth;
  same_receivers[y / SHADOW_TILE * ((width + SHADOW_TILE - 1) / SHADOW_TILE) + x / SHADOW_TILE] = 0;
}
