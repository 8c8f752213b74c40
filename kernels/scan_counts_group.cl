// Exclusive prefix sum of the counts of cells, for GPUs: one work-group of GROUP items, GROUP cells at a time.
// The same contract and bytes as scan_counts_lanes.cl.
#ifndef GROUP
#define GROUP 256
#endif

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void scan_counts_group(global uint2* cells, uint count,
                                                                                global ulong* totals, uint slot) {
  local ulong scratch[2 * GROUP];
  const uint item = get_local_id(0);
  ulong before = 0;
  for (uint base = 0; base < count; base += GROUP) {
    const uint i = base + item;
    const uint mine = i < count ? cells[i].y : 0u;
    uint from = 0;
    scratch[item] = mine;
    for (uint step = 1; step < GROUP; step *= 2) {
      barrier(CLK_LOCAL_MEM_FENCE);
      const ulong value = scratch[from + item] + (item >= step ? scratch[from + item - step] : 0ul);
      from = GROUP - from;
      scratch[from + item] = value;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (i < count) cells[i].x = (uint)(before + scratch[from + item] - mine);
    before += scratch[from + GROUP - 1];
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (item == 0) totals[slot] = before;
}
