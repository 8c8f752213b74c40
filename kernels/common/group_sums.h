// Sums and prefix sums over a work-group of GROUP items; every item calls them. Items are added up in
// segments, then the segments' sums: three barriers, where a tree takes seven to eleven.
#pragma once

#ifndef GROUP
#define GROUP 64
#endif
#define SEGMENT (GROUP > 256 ? 32 : 16)  // items
#define SEGMENTS (GROUP / SEGMENT)

// Sum of all items' `mine`. scratch: GROUP, free again after the next barrier.
static inline ulong sum_of_group(ulong mine, local ulong* scratch) {
  const uint item = get_local_id(0);
  scratch[item] = mine;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < SEGMENTS) {
    for (uint i = 1; i < SEGMENT; ++i) mine += scratch[i * SEGMENTS + item];
    scratch[item] = mine;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item == 0) {
    for (uint i = 1; i < SEGMENTS; ++i) mine += scratch[i];
    scratch[0] = mine;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return scratch[0];
}

// A padding word after each segment keeps items that each read their own segment in different banks.
#define PREFIX_SCRATCH (GROUP + SEGMENTS + SEGMENTS + 1)

// (sum of `mine` of lower items, sum of all). scratch: PREFIX_SCRATCH, free again after the next barrier.
static inline uint2 prefix_sum(uint mine, local uint* scratch) {
  const uint item = get_local_id(0), segment = item / SEGMENT;
  local uint* sums = scratch + GROUP + SEGMENTS;  // sums of lower segments, and of all
  scratch[item + segment] = mine;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < SEGMENTS) {
    local uint* values = scratch + item * (SEGMENT + 1);
    uint held[SEGMENT], sum = 0;
    for (uint i = 0; i < SEGMENT; ++i) held[i] = values[i];
    for (uint i = 0; i < SEGMENT; ++i) {
      values[i] = sum;
      sum += held[i];
    }
    values[SEGMENT] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item <= SEGMENTS) {
    uint sum = 0;
    for (uint i = 0; i < item; ++i) sum += scratch[i * (SEGMENT + 1) + SEGMENT];
    sums[item] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return (uint2)(sums[segment] + scratch[item + segment], sums[SEGMENTS]);
}
