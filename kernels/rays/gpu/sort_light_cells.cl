// The last step to light cells on GPUs: sorts the list of each cell, the nearest first.
//
// jobs  LightCellJob
// pool  in: starts; in and out: LightCellEntry
#include "kernels/rays/gpu/light_cell_group.h"

// By Shell's method with Knuth's gaps. The upper half of an entry is its distance.
static inline void sort_list(global ulong* entries, uint count) {
  uint gap = 1;
  while (gap < count / 3) gap = 3 * gap + 1;
  for (; gap != 0; gap /= 3) {
    for (uint i = gap; i < count; ++i) {
      const ulong one = entries[i];
      uint at = i;
      for (; at >= gap && entries[at - gap] > one; at -= gap) entries[at] = entries[at - gap];
      entries[at] = one;
    }
  }
}

LIGHT_CELL_KERNEL(sort_light_cells)(global const LightCellJob* jobs, global uint* pool) {
  global const LightCellJob* job = JOB;
  if (!entries_fit(job)) return;
  global const uint* starts = pool + job->first_start;
  // The last start of a face is where the next face begins.
  FOR_ITEMS(i, starts_of_job(job) - 1) sort_list((global ulong*)pool + starts[i], starts[i + 1] - starts[i]);
}
