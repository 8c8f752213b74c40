// Sums and places within a work-group of GROUP items. Every item calls these. Runs of items are added up first, then the
// runs' sums: three barriers for the seven to eleven of a tree, and most items wait in them.
#pragma once

#ifndef GROUP
#define GROUP 64
#endif
#define RUN (GROUP > 256 ? 32 : 16)  // items
#define RUNS (GROUP / RUN)

// Sum of all items' `mine`. scratch: GROUP, free again after the next barrier.
static inline ulong sum_of_group(ulong mine, local ulong* scratch) {
  const uint item = get_local_id(0);
  scratch[item] = mine;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < RUNS) {
    for (uint i = 1; i < RUN; ++i) mine += scratch[i * RUNS + item];
    scratch[item] = mine;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item == 0) {
    for (uint i = 1; i < RUNS; ++i) mine += scratch[i];
    scratch[0] = mine;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return scratch[0];
}

// A word after each run: items that each read their own run use other banks.
#define APPEND_SCRATCH (GROUP + RUNS + RUNS + 1)

// (sum of `mine` of lower items, sum of all). scratch: APPEND_SCRATCH, free again after the next barrier.
static inline uint2 append_place(uint mine, local uint* scratch) {
  const uint item = get_local_id(0), run = item / RUN;
  local uint* sums = scratch + GROUP + RUNS;  // of lower runs, and of all
  scratch[item + run] = mine;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < RUNS) {
    local uint* values = scratch + item * (RUN + 1);
    uint held[RUN], sum = 0;
    for (uint i = 0; i < RUN; ++i) held[i] = values[i];
    for (uint i = 0; i < RUN; ++i) values[i] = sum, sum += held[i];
    values[RUN] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item <= RUNS) {
    uint sum = 0;
    for (uint i = 0; i < item; ++i) sum += scratch[i * (RUN + 1) + RUN];
    sums[item] = sum;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return (uint2)(sums[run] + scratch[item + run], sums[RUNS]);
}
