// The lights marked for each bin, gathered in their order, for GPUs: one work-group of GROUP items a bin.
//
// views, marks  as project_lights_group.cl and mark_bins_group.cl write them
// pool          candidates: VIEW_ARRAYS arrays a bin, in blocks of 16 lights: how many were asked for is in counters[0]
// bins          uint4 a bin: its first block, number of candidates, where its cells' marks will lie (in units of 16
//               words: counters[1]), and 0, to which mark_cells_group.cl adds the number of its indices
//
// Where room runs out a bin writes nothing; the host reads what was asked for and runs the kernels again with more.
// -DGROUP  items a group, a power of two (default 256)
#ifndef GROUP
#define GROUP 256
#endif
#define LANES 1
#include "kernels/common/bin_cells.h"
#include "kernels/common/append.h"

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void list_candidates_group(
    global const float* views, global const uint* marks, global float* pool, global uint4* bins,
    global volatile uint* counters, constant CullParams* p) {
  local uint scratch[2 * GROUP];
  local uint block, room;
  const uint bin = get_group_id(0), item = get_local_id(0), words = (p->light_count + 31) / 32;
  const size_t stride = p->light_stride;
  marks += (size_t)bin * words;
  uint mine = 0;
  for (uint w = item; w < words; w += GROUP) mine += popcount(marks[w]);
  scratch[item] = mine;
  for (uint step = GROUP / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < step) scratch[item] += scratch[item + step];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint count = scratch[0];
  if (item == 0) {
    const uint blocks = (count + 15) / 16, units = (count + 31) / 32 * (BIN_SIZE / 16) * p->slices;
    const uint at = atomic_add(counters, blocks), marks_at = atomic_add(counters + 1, units);
    const bool fits = (ulong)at + blocks <= p->pool_blocks && (ulong)marks_at + units <= p->staging_units;
    bins[bin] = (uint4)(at, fits ? count : 0u, marks_at, 0u);
    block = at, room = fits;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const size_t to_stride = (count + 15) / 16 * 16;
  global float* to = pool + (size_t)block * 16 * VIEW_ARRAYS;
  uint n = 0;
  for (uint base = 0; base < words; base += GROUP) {
    const uint w = base + item;
    uint bits = room && w < words ? marks[w] : 0u;
    const uint2 at = append_place(popcount(bits), scratch);
    for (uint k = n + at.x; bits; bits &= bits - 1, ++k) {
      global const float* from = views + w * 32 + lowest_bit(bits);
      for (uint a = 0; a < VIEW_ARRAYS; ++a) to[a * to_stride + k] = from[a * stride];
    }
    n += at.y;
  }
}
