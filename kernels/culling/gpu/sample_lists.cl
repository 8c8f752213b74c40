// Shortens lists of the light grid to `cap` lights drawn at random, for GPUs, to the same bytes as
// culling/cpu/sample_lists.cl, which says what the arguments are. A work-group of GROUP items takes a cell, an
// item each GROUP-th light.
//
// Which lights are certain does not depend on the order in which they are found: one that is taken leaves a
// smaller share for a slot, so that another one that was heavy enough stays so.
#define GROUP 32
#include "kernels/common/group_sums.h"
#include "kernels/culling/sampled_list.h"

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void sample_lists(
    global uint2* cells, global index_t* indices, uint cell_count, uint cap, uint seed, global uint* factors,
    LIGHT_ARGUMENTS global const float* bounds, uint planes, global const float* slice_edges,
    constant CullParams* p) {
  local ulong sums[GROUP];
  local uint scratch[PREFIX_SCRATCH], most, keeping;
  const uint cell = get_group_id(0), item = get_local_id(0);
  const uint first = cells[cell].x, count = cells[cell].y;
  global index_t* list = indices + first;
  factors += first;
  if (count <= cap) {
    for (uint i = item; i < count; i += GROUP) factors[i] = as_uint(1.0f);
    return;
  }
  if (item == 0) most = 0;
  barrier(CLK_LOCAL_MEM_FENCE);
  const LightColumns lights = {GIVEN_LIGHTS};
  const CellCentre middle = cell_centre_of(cell, bounds, planes, slice_edges, p);
  uint heaviest = 0;  // bits of positive floats are ordered as these are
  for (uint i = item; i < count; i += GROUP) {
    factors[i] = as_uint(weight_of(light_at(&lights, list[i]), middle));
    heaviest = max(heaviest, factors[i]);
  }
  atomic_max(&most, heaviest);
  barrier(CLK_LOCAL_MEM_FENCE);
  const float scale = MOST_WEIGHT / as_float(most);
  ulong mine = 0;
  for (uint i = item; i < count; i += GROUP) {
    factors[i] = whole_weight(as_float(factors[i]), scale);
    mine += factors[i];
  }
  ulong rest = sum_of_group(mine, sums);  // the weights of lights that are not certain
  uint slots = cap;                       // left for them
  while (true) {
    barrier(CLK_LOCAL_MEM_FENCE);
    ulong taken = 0;  // how many times 2^56, and their weights
    for (uint i = item; i < count; i += GROUP) {
      const uint weight = factors[i];
      if ((weight & CERTAIN) || (ulong)weight * slots < rest) continue;
      factors[i] = weight | CERTAIN;
      taken += (1ul << 56) + weight;
    }
    taken = sum_of_group(taken, sums);
    if (taken == 0) break;
    rest -= taken & ((1ul << 56) - 1);
    slots -= (uint)(taken >> 56);
  }
  const ulong place = first_place(rest, random_of_cell(cell, seed, p));
  ulong before = 0;  // the weights of lights that are not certain, of lower i
  uint kept = 0;
  for (uint base = 0; base < count; base += GROUP) {
    const uint i = base + item, given = i < count ? factors[i] : 0, weight = given & CERTAIN ? 0 : given;
    const index_t light = i < count ? list[i] : 0;
    if (item == 0) keeping = 0;
    const uint2 weights = prefix_sum(weight, scratch);
    const ulong at = (place + (before + weights.x) * slots) % rest;
    const bool keeps = (given & CERTAIN) || at + (ulong)weight * slots >= rest;
    if (keeps) atomic_or(&keeping, 1u << item);
    barrier(CLK_LOCAL_MEM_FENCE | CLK_GLOBAL_MEM_FENCE);
    if (keeps) {
      const uint to = kept + popcount(keeping & ((1u << item) - 1));
      list[to] = light;
      factors[to] = as_uint(given & CERTAIN ? 1.0f : factor_of(rest, slots, weight));
    }
    before += weights.y;
    kept += popcount(keeping);
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (item == 0) cells[cell].y = kept;
}
