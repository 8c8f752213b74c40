// Writes the light grid from each bin's staged lists, for CPUs. A work-item takes `run` bins in sequence: it
// adds up the totals of the bins before them and copies its own bins' lists behind theirs.
//
// bins, cell_counts, staged  as culling/cpu/cull_lights.cl writes them
// cells     uint2 a cell: first, count; x fastest, then y, then slice
// indices   the light index list
// counters  [4], [5] = low and high word of the number of indices; past 2^32 the host refuses
#include "kernels/common/index_type.h"
#include "kernels/common/one_item.h"
#include "shared/cull_params.h"
#include "shared/light_grid.h"

#ifdef SLICES
#define SLICE_COUNT (p->slices)
#else
#define SLICE_COUNT 1u
#endif
#ifdef __clang__  // PoCL 3.1 turns vstore16 of ushort into 16 stores
typedef index_t unaligned_indices __attribute__((ext_vector_type(16), aligned(2)));
#define COPY_16(to, from) *(global unaligned_indices*)(to) = *(global const unaligned_indices*)(from)
#else
#define COPY_16(to, from) vstore16(vload16(0, from), 0, to)
#endif

static inline void write_bin(uint bin, uint first, global const uint2* bins, global const uint* cell_counts,
                             global const index_t* staged, global uint2* cells, global index_t* indices,
                             constant CullParams* p) {
  const uint count = bins[bin].y;
  global const index_t* from = staged + (size_t)bins[bin].x * 16;
  global index_t* to = indices + first;
  uint i = 0;
  for (; i + 16 <= count; i += 16) COPY_16(to + i, from + i);
  for (; i < count; ++i) to[i] = from[i];

  global const uint* counts = cell_counts + bin * BIN_SIZE * SLICE_COUNT;
  for (uint quad = 0; quad < BIN_SIZE; quad += 4) {
    const uint tx0 = bin % p->bins_x * BIN_TILES + tile_x_of_slot(quad);
    const uint ty0 = bin / p->bins_x * BIN_TILES + tile_y_of_slot(quad);
#pragma unroll
    for (uint i = 0; i < 4; ++i) {
      const uint tx = tx0 + (i & 1), ty = ty0 + (i >> 1);
      if (tx >= p->tiles_x || ty >= p->tiles_y) continue;
      for (uint slice = 0; slice < SLICE_COUNT; ++slice) {
        const uint n = counts[(quad + i) * SLICE_COUNT + slice];
        cells[(slice * p->tiles_y + ty) * p->tiles_x + tx] = (uint2)(first, n);
        first += n;
      }
    }
  }
}

kernel ONE_ITEM void write_lists(global const uint2* bins, uint run, global const uint* cell_counts,
                                 global const index_t* staged, global uint2* cells, global index_t* indices,
                                 global uint* counters, constant CullParams* p) {
  ASSUME_ONE_ITEM;
  const uint all = p->bins_x * p->bins_y, begin = get_global_id(0) * run, end = min(begin + run, all);
  ulong before = 0;
  for (uint i = 0; i < begin; ++i) before += bins[i].y;
  for (uint bin = begin; bin < end; ++bin) {
    const ulong after = before + bins[bin].y;
    if (after <= p->index_capacity)
      write_bin(bin, (uint)before, bins, cell_counts, staged, cells, indices, p);
    before = after;
  }
  if (end == all) {
    counters[4] = (uint)before;
    counters[5] = (uint)(before >> 32);
  }
}
