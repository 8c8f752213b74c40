// The fourth step to light cells on GPUs: replaces each cell's number of entries by where they begin. A
// work-group per light.
//
// jobs  in and out: LightCellJob
// pool  in and out: starts
#include "kernels/rays/gpu/light_cell_group.h"

#include "kernels/common/group_sums.h"

LIGHT_CELL_KERNEL(sum_light_cells)(global LightCellJob* jobs, global uint* pool) {
  local uint scratch[PREFIX_SCRATCH];
  local ulong sums[GROUP];
  global LightCellJob* job = JOB;
  global uint* starts = pool + job->first_start;
  const uint all = starts_of_job(job), each = (all + GROUP - 1) / GROUP,
             first = min((uint)get_local_id(0) * each, all), end = min(first + each, all);
  uint mine = 0;
  ulong squares = 0;
  for (uint i = first; i < end; ++i) {
    mine += starts[i];
    squares += (ulong)starts[i] * starts[i];
  }
  const uint2 before = prefix_sum(mine, scratch);
  uint sum = job->first_entry + before.x;
  for (uint i = first; i < end; ++i) {
    const uint here = starts[i];
    starts[i] = sum;
    sum += here;
  }
  squares = sum_of_group(squares, sums);
  if (get_local_id(0) == 0) {
    job->entries = before.y;
    job->list_length = (float)squares / (float)max(before.y, 1u);
  }
}
