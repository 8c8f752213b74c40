// From sorted pairs to blocks: where each block's lights begin, its key, and each bucket's first block. Runs
// twice: to count blocks, then, after world_scan, to write.
//
// pairs        in: sorted by bucket, those of one block side by side
// totals       a chunk's number of blocks out; with `write` its first block in
// block_first  out: each block's first light in `members`, and one more for the end
// keys         out: of each block
// members      out: lights of the pairs, and 15 more numbers of lights, which
//              world_lists loads and does not use
// buckets      out: bucket_count + 1 first blocks
kernel void world_entries(global const uint4* pairs, global uint* totals, global uint* block_first,
                          global uint2* keys, global uint* members, global uint* buckets, uint bucket_count,
                          uint count, uint chunk, uint write) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= count) return;
  const uint end = min(item * chunk + chunk, count);
  uint block = write ? totals[item] : 0;
  for (uint i = item * chunk; i < end; ++i) {
    const uint4 pair = pairs[i];
    if (write) members[i] = pair.y;
    if (i == 0 || any(pair.zw != pairs[i - 1].zw)) {
      if (write) {
        block_first[block] = i;
        keys[block] = pair.zw;
        for (uint b = i == 0 ? 0 : pairs[i - 1].x + 1; b <= pair.x; ++b) buckets[b] = block;
      }
      ++block;
    }
    if (!write || i + 1 < count) continue;
    block_first[block] = count;
    for (uint past = 0; past < 15; ++past) members[count + past] = pair.y;
    for (uint b = pair.x + 1; b <= bucket_count; ++b) buckets[b] = block;
  }
  if (!write) totals[item] = block;
}
