// Which candidates of its bin may touch each cell, a bit each, for GPUs: one work-group of BIN_SIZE items takes a bin, an
// item each of its tiles, and walks words of 32 candidates. All items read the same light at a time.
//
// pool, bins  as list_candidates_group.cl writes them; bins[].w += number of indices
// bounds      as depth_bounds_group.cl writes them
// slices      where there are some: as kernels/common/bin_cells.h says
// marks       a bin's cells (BIN_SIZE slots, slices each), a word for each 32 candidates
#define LANES 1
#include "kernels/common/bin_cells.h"

kernel __attribute__((reqd_work_group_size(BIN_SIZE, 1, 1))) void mark_cells_group(
    global const float* pool, global uint* bins, global const float* bounds, global const float2* slices,
    global uint* marks, constant CullParams* p) {
  local uint total;
  const uint bin = get_group_id(0), slot = get_local_id(0);
  const uint count = bins[4 * bin + 1], words = (count + 31) / 32;
  if (get_group_id(1) >= words) return;
  if (slot == 0) total = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  bounds += bin * BOUND_PLANES * BIN_SIZE;
  marks += (size_t)bins[4 * bin + 2] * 16;
  const size_t stride = (count + 15) / 16 * 16;
  global const float* candidates = pool + (size_t)bins[4 * bin] * 16 * VIEW_ARRAYS;
  const uint bx = bin % p->bins_x, by = bin / p->bins_x;
  const int tx = (int)(bx * BIN_TILES + tile_x_of_slot(slot)), ty = (int)(by * BIN_TILES + tile_y_of_slot(slot));
  uint kept = 0;
  for (uint slice = 0; slice < p->slices; ++slice) {
    TestCell cell;
    const bool some = make_test_cell(bounds, bx, by, slot, slice, slices, &cell, p);
    for (uint w = get_group_id(1); w < words; w += get_num_groups(1)) {
      uint bits = 0;
      const uint lights = some ? min(32u, count - w * 32) : 0u;
      for (uint i = 0; i < lights; ++i) {
        global const float* light = candidates + w * 32 + i;
        const TileRect rect = {as_int(light[VIEW_FIRST * stride]), as_int(light[VIEW_LAST * stride])};
        if (rect_meets(rect, tx | ty << 16, tx | ty << 16) && light_may_touch(light, stride, &cell, p)) bits |= 1u << i;
      }
      marks[((size_t)slot * p->slices + slice) * words + w] = bits;
      kept += popcount(bits);
    }
  }
  atomic_add(&total, kept);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (slot == 0) atomic_add((global volatile uint*)&bins[4 * bin + 3], total);
}
