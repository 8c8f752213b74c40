// Writes the light grid from the cells' marks, for GPUs. A work-group of GROUP items takes a block of tiles,
// adds up the totals of the blocks before it, and writes its lists in order, an item a run of words.
//
// ids, offsets, totals, marks  as culling/gpu/cull_lights.cl writes them
// cells     uint2 a cell: first, and count as culling/gpu/cull_lights.cl has written it; x fastest, then y, then
//           slice
// indices   the light index list
// counters  [4], [5] = low and high word of the number of indices; past 2^32 the host refuses
// -DGROUP   items a group, a power of two (default 256)
#ifndef GROUP
#define GROUP 256
#endif
#define LANES 1
#include "kernels/common/group_sums.h"
#include "kernels/common/index_type.h"
#include "kernels/culling/group_grid.h"

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void write_lists(
    global const uint* ids, global const uint4* offsets, global const ulong* totals, global const uint* marks,
    global uint2* cells, global index_t* indices, global uint* counters, constant CullParams* p) {
  local uint scratch[PREFIX_SCRATCH];
  local ulong sums[GROUP];
  const uint block = get_group_id(0), item = get_local_id(0);
  const uint4 offset = offsets[block];
  const uint words = (offset.y + 31) / 32, block_cells = BLOCK_SIZE * p->slices, all = block_cells * words;
  const uint each = (all + GROUP - 1) / GROUP, from = min(item * each, all), to = min(from + each, all);
  ids += (size_t)offset.x * 16;
  marks += (size_t)offset.z * 16;
  ulong sum = 0;
  for (uint i = item; i < block; i += GROUP) sum += totals[i];
  uint mine = 0;
  for (uint i = from; i < to; ++i) mine += popcount(marks[i]);
  const ulong before = sum_of_group(sum, sums), end = before + totals[block];
  const uint mine_at = prefix_sum(mine, scratch).x;
  if (item == 0 && block + 1 == BLOCKS_X(p) * BLOCKS_Y(p)) {
    counters[4] = (uint)end;
    counters[5] = (uint)(end >> 32);
  }
  if (end > p->index_capacity) return;

  uint cell, at = (uint)before + mine_at;
  for (uint c = item; words == 0 && c < block_cells; c += GROUP) {
    if (cell_of(block, c / p->slices, c % p->slices, &cell, p)) cells[cell].x = at;
  }
  for (uint i = from; i < to; ++i) {
    const uint c = i / words, w = i % words;
    if (w == 0 && cell_of(block, c / p->slices, c % p->slices, &cell, p)) cells[cell].x = at;
    for (uint bits = marks[i]; bits; bits &= bits - 1, ++at)
      indices[at] = (index_t)ids[w * 32 + lowest_bit(bits)];
  }
}
