// Which lights may touch each bin, a bit each, for GPUs: one work-item takes 32 lights against one bin. Neighbouring items
// take neighbouring bins, so that they read the same lights.
//
// views  as project_lights_group.cl writes them
// boxes  as bin_boxes_group.cl writes them
// marks  light_stride / 32 words a bin, rounded up
#define LANES 1
#include "kernels/common/bin_cells.h"

kernel void mark_bins_group(global const float* views, global const Cell* boxes, global uint* marks,
                            constant CullParams* p) {
  const uint bin = get_global_id(0), word = get_global_id(1), bins = p->bins_x * p->bins_y;
  if (bin >= bins) return;
  const size_t stride = p->light_stride;
  const Cell box = boxes[bin];
  uint bits = 0;
  if (box.near <= box.far) {
    const int x = (int)(bin % p->bins_x * BIN_TILES), y = (int)(bin / p->bins_x * BIN_TILES);
    const int first = x | y << 16, last = (x + 7) | (y + 7) << 16;
    const uint lights = min(32u, p->light_count - word * 32);
    for (uint i = 0; i < lights; ++i) {
      global const float* v = views + word * 32 + i;
      const TileRect rect = {as_int(v[VIEW_FIRST * stride]), as_int(v[VIEW_LAST * stride])};
      if (rect_meets(rect, first, last) && may_touch_coarsely(load_sphere(v, stride), &box)) bits |= 1u << i;
    }
  }
  marks[bin * ((p->light_count + 31) / 32) + word] = bits;
}
