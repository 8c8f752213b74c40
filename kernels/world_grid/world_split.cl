// Blocks whose keys have the same hash share a bucket. Orders the pairs of each bucket by block, in the order
// in which the blocks first occur, and stably. The item in whose chunk a bucket begins takes it.
//
// pairs    sorted by bucket; in and out
// scratch  of the same size
kernel void world_split(global uint4* pairs, global uint4* scratch, uint count, uint chunk) {
  const ulong begin = (ulong)get_global_id(0) * chunk;
  if (begin >= count) return;
  const uint chunk_end = min((uint)begin + chunk, count);
  for (uint first = (uint)begin; first < chunk_end;) {
    const uint bucket = pairs[first].x;
    uint end = first;
    bool mixed = false;
    for (; end < count && pairs[end].x == bucket; ++end) mixed |= any(pairs[end].zw != pairs[first].zw);
    const bool own = first == 0 || pairs[first - 1].x != bucket;
    if (own && mixed) {
      uint at = first;
      for (uint i = first; i < end; ++i) scratch[i] = pairs[i];
      for (uint head = first; at < end; ++head) {
        const uint2 key = scratch[head].zw;
        if (scratch[head].x != bucket) continue;  // taken with an earlier one
        for (uint i = head; i < end; ++i) {
          if (scratch[i].x != bucket || any(scratch[i].zw != key)) continue;
          pairs[at++] = scratch[i];
          scratch[i].x = ~bucket;
        }
      }
    }
    first = end;
  }
}
