// Ordered append within a work-group: where each item that has something puts it.
#pragma once

#ifndef GROUP
#define GROUP 64
#endif

// Called by every item of the group. Returns (sum of `mine` of lower items, sum of all).
// scratch: 2 * GROUP. Inclusive scan after Hillis and Steele (1986); two buffers, so that no item reads what
// another is writing.
static inline uint2 append_place(uint mine, local uint* scratch) {
  const uint item = get_local_id(0);
  uint from = 0;
  scratch[item] = mine;
  for (uint step = 1; step < GROUP; step *= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint value = scratch[from + item] + (item >= step ? scratch[from + item - step] : 0u);
    from = GROUP - from;
    scratch[from + item] = value;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint2 place = (uint2)(scratch[from + item] - mine, scratch[from + GROUP - 1]);
  barrier(CLK_LOCAL_MEM_FENCE);  // the next call overwrites scratch
  return place;
}
