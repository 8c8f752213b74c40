// The light grid from the cells' marks, for GPUs: one work-group of GROUP items takes a bin, adds up the totals of those
// before it, and writes its lists in order.
//
// pool, bins, marks  as list_candidates_group.cl and mark_cells_group.cl write them
// cells     uint2 a cell: first, count; x fastest, then y, then slice
// indices   the light index list
// counters  [4], [5] = low and high word of the number of indices, which can pass 32 bits; the host then refuses
// -DGROUP   items a group, a power of two (default 256)
#ifndef GROUP
#define GROUP 256
#endif
#define LANES 1
#include "kernels/common/bin_cells.h"
#include "kernels/common/append.h"

#ifdef INDEX_32
typedef uint index_t;
#else
typedef ushort index_t;
#endif

static inline bool cell_of(uint cell, uint bin, uint* index, constant CullParams* p) {
  const uint slot = cell / p->slices, slice = cell % p->slices;
  const uint tx = bin % p->bins_x * BIN_TILES + tile_x_of_slot(slot), ty = bin / p->bins_x * BIN_TILES + tile_y_of_slot(slot);
  *index = (slice * p->tiles_y + ty) * p->tiles_x + tx;
  return tx < p->tiles_x && ty < p->tiles_y;
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void fill_lists_group(
    global const float* pool, global const uint4* bins, global const uint* marks, global uint2* cells,
    global index_t* indices, global uint* counters, constant CullParams* p) {
  local uint scratch[2 * GROUP];
  local ulong sums[GROUP];
  const uint bin = get_group_id(0), item = get_local_id(0);
  const uint4 place = bins[bin];
  const uint words = (place.y + 31) / 32, all_cells = BIN_SIZE * p->slices;
  ulong sum = 0;
  for (uint i = item; i < bin; i += GROUP) sum += bins[i].w;
  sums[item] = sum;
  for (uint step = GROUP / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < step) sums[item] += sums[item + step];
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const ulong before = sums[0], end = before + place.w;
  if (item == 0 && bin + 1 == p->bins_x * p->bins_y) counters[4] = (uint)end, counters[5] = (uint)(end >> 32);
  if (end > p->index_capacity) return;

  marks += (size_t)place.z * 16;
  global const float* ids = pool + (size_t)place.x * 16 * VIEW_ARRAYS + VIEW_ID * (size_t)((place.y + 15) / 16 * 16);
  uint first = (uint)before;
  const uint2 none = (uint2)(first, 0u);
  for (uint c = item; words == 0 && c < all_cells; c += GROUP) {
    uint index;
    if (cell_of(c, bin, &index, p)) cells[index] = none;
  }
  for (uint base = 0; base < all_cells * words; base += GROUP) {
    const uint i = base + item;
    uint bits = i < all_cells * words ? marks[i] : 0u;
    const uint2 at = append_place(popcount(bits), scratch);
    uint to = first + at.x, index;
    const uint w = i % max(words, 1u);
    if (i < all_cells * words && w == 0 && cell_of(i / words, bin, &index, p)) cells[index].x = to;
    for (; bits; bits &= bits - 1, ++to) indices[to] = (index_t)as_uint(ids[w * 32 + lowest_bit(bits)]);
    first += at.y;
  }
  barrier(CLK_GLOBAL_MEM_FENCE);
  for (uint c = item; words != 0 && c < all_cells; c += GROUP) {
    uint index;
    if (!cell_of(c, bin, &index, p)) continue;
    uint count = 0;
    for (uint w = 0; w < words; ++w) count += popcount(marks[(size_t)c * words + w]);
    cells[index].y = count;
  }
}
