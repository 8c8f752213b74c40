// Sums of all values before each, in place. One work-group of at most 256 items, each with a run of values;
// bytes do not depend on the number of items.
//
// values   `count` in and out
// total    out: the sum of all, low word first. Past 32 bits `values` are of no use
kernel void world_scan(global uint* values, uint count, global uint* total) {
  local ulong sums[256];
  const uint item = get_local_id(0), items = get_local_size(0);
  const uint run = (count + items - 1) / items, first = min(item * run, count), end = min(first + run, count);
  ulong sum = 0;
  for (uint i = first; i < end; ++i) sum += values[i];
  sums[item] = sum;
  barrier(CLK_LOCAL_MEM_FENCE);
  ulong at = 0;
  for (uint i = 0; i < item; ++i) at += sums[i];
  for (uint i = first; i < end; ++i) {
    const uint value = values[i];
    values[i] = (uint)at;
    at += value;
  }
  if (item + 1 < items) return;
  total[0] = (uint)at;
  total[1] = (uint)(at >> 32);
}
