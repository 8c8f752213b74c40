// Exclusive prefix sum of the counts of cells, for CPUs: one work-item.
// cells  uint2 each: reads .y (count), writes .x (first)
// totals[slot]  the sum of all, in 64 bits: cells x lights can pass 32. Where it does, .x has wrapped; the host refuses.
kernel void scan_counts_lanes(global uint2* cells, uint count, global ulong* totals, uint slot) {
  ulong sum = 0;
  for (uint i = 0; i < count; ++i) {
    cells[i].x = (uint)sum;
    sum += cells[i].y;
  }
  totals[slot] = sum;
}
