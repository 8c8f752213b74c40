// The box around all that a bin's tiles show, for GPUs: one work-group of BIN_SIZE items a bin.
//
// bounds  as depth_bounds_group.cl writes them
// boxes   a Cell a bin; near > far where it shows nothing
#define LANES 1
#include "kernels/common/bin_cells.h"

kernel __attribute__((reqd_work_group_size(BIN_SIZE, 1, 1))) void bin_boxes_group(global const float* bounds,
                                                                                  global Cell* boxes,
                                                                                  constant CullParams* p) {
  local float lows[3][BIN_SIZE], highs[3][BIN_SIZE];
  const uint bin = get_group_id(0), slot = get_local_id(0);
  bounds += bin * BOUND_PLANES * BIN_SIZE;
  const uint tx = bin % p->bins_x * BIN_TILES + tile_x_of_slot(slot), ty = bin / p->bins_x * BIN_TILES + tile_y_of_slot(slot);
  const TileSides sides = tile_sides(tx, ty, p);
  float low[3] = {NOTHING, NOTHING, NOTHING}, high[3] = {-NOTHING, -NOTHING, -NOTHING};
  for (int i = 0; i < INTERVALS; ++i) {
    const float near = at_slot(bounds, 2 * i, slot), far = at_slot(bounds, 2 * i + 1, slot);
    if (near > far) continue;
    const Box box = box_between(sides, near, far, p);
    low[0] = min(low[0], near), high[0] = max(high[0], far);
    low[1] = min(low[1], box.x0), high[1] = max(high[1], box.x1);
    low[2] = min(low[2], box.y0), high[2] = max(high[2], box.y1);
  }
  for (int i = 0; i < 3; ++i) lows[i][slot] = low[i], highs[i][slot] = high[i];
  for (uint step = BIN_SIZE / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = 0; i < 3 && slot < step; ++i) {
      lows[i][slot] = min(lows[i][slot], lows[i][slot + step]);
      highs[i][slot] = max(highs[i][slot], highs[i][slot + step]);
    }
  }
  if (slot != 0) return;
  Cell c = {lows[0][0], highs[0][0], lows[1][0], highs[1][0], lows[2][0], highs[2][0]};
  boxes[bin] = c;
}
