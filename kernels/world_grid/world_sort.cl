// One pass of a stable radix sort of pairs by bucket. Runs twice: to count each chunk's digits, then, after
// world_scan, to move the pairs. Stable: pairs of one bucket stay in the order of their lights.
//
// from, to  pairs as world_blocks writes them
// totals    chunks values a digit: numbers out; with `write` the first places in
// shift, digits  of the bucket: (bucket >> shift) & (digits - 1); digits is a power of two, at most
// MOST_DIGITS
#define MOST_DIGITS 2048

kernel void world_sort(global const uint4* from, global uint4* to, global uint* totals, uint count,
                       uint chunk, uint chunks, uint shift, uint digits, uint write) {
  const uint item = get_global_id(0);
  if (item >= chunks) return;
  const uint end = min(item * chunk + chunk, count);
  uint at[MOST_DIGITS];
  for (uint d = 0; d < digits; ++d) at[d] = write ? totals[d * chunks + item] : 0;
  for (uint i = item * chunk; i < end; ++i) {
    const uint digit = from[i].x >> shift & (digits - 1);
    if (write) to[at[digit]] = from[i];
    ++at[digit];
  }
  if (write) return;
  for (uint d = 0; d < digits; ++d) totals[d * chunks + item] = at[d];
}
