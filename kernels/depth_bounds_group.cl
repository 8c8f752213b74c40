// Depth bounds of every tile, for GPUs: one work-group of GROUP items reduces one tile. The same contract, arguments and
// bytes as depth_bounds_lanes.cl.
// -DGROUP  items a group, a power of two (default 64)
#define LANES 1
#include "kernels/common/depth_bounds.h"

#ifndef GROUP
#define GROUP 64
#endif

// Least `low`, greatest `high` and least `lowest` of the group, for every item of it.
static inline uint3 reduce_group(uint3 mine, local uint3* scratch) {
  const uint item = get_local_id(0);
  scratch[item] = mine;
  for (uint step = GROUP / 2; step > 0; step /= 2) {
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < step) {
      const uint3 other = scratch[item + step];
      mine = (uint3)(min(mine.x, other.x), max(mine.y, other.y), min(mine.z, other.z));
      scratch[item] = mine;
    }
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  return scratch[0];
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void depth_bounds_group(
    global const uint* depth, global float* opaque, global float* blend, global volatile uint* counters,
    constant CullParams* p) {
  local uint3 scratch[GROUP];
  local uint mask;
  const uint tx = get_group_id(0), ty = get_group_id(1), item = get_local_id(0);
  const uint columns = min((uint)TILE, p->width - tx * TILE) * SAMPLES, rows = min((uint)TILE, p->height - ty * TILE);
  global const uint* first = depth + p->depth_first + (size_t)ty * TILE * p->depth_row + tx * ROW;
  uint3 keys = (uint3)(0xffffffffu, 0u, 0xffffffffu);
  for (uint i = item; i < TILE * ROW; i += GROUP) {
    const uint x = i % ROW, y = i / ROW;
    if (x < columns && y < rows) {
      const uint key = KEY(first[(size_t)y * p->depth_row + x]);
      keys = (uint3)(min(keys.x, key - 1u), max(keys.y, key), min(keys.z, key));
    }
  }
  if (item == 0) mask = 0u;
  keys = reduce_group(keys, scratch);
  const uint low = keys.x + 1u, high = keys.y;
  const Interval all = opaque_interval(low, high, p);
  float planes[4] = {all.near, all.far, FAR_AWAY, -FAR_AWAY};
  const float middle = 0.5f * (all.near + all.far);
#if DEPTH_MODE == DEPTH_HALFZ
  if (all.near <= all.far) planes[1] = planes[2] = middle, planes[3] = all.far;
#elif DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  const uint cut = KEY(as_uint(depth_of_distance(middle, p)));
  uint3 around = (uint3)(0xffffffffu, 0u, 0u);
#elif DEPTH_MODE == DEPTH_MASK32
  uint slots = 0u;
#endif
#ifdef SECOND_LOOK
  barrier(CLK_LOCAL_MEM_FENCE);  // scratch is free again
  if (high != 0u && high <= ONE_BITS) {
    for (uint i = item; i < TILE * ROW; i += GROUP) {
      const uint x = i % ROW, y = i / ROW;
      if (x >= columns || y >= rows) continue;
      const uint key = KEY(first[(size_t)y * p->depth_row + x]);
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
      if (key >= cut) around.x = min(around.x, key);
      if (key < cut) around.y = max(around.y, key);
#else
      if (key != 0u) slots |= 1u << mask_slot(distance_of_depth(as_float(KEY(key)), p), all.near, all.far);
#endif
    }
  }
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  around = reduce_group(around, scratch);
  if (high <= ONE_BITS) {
    const Interval nearer = opaque_interval(around.x, around.x == 0xffffffffu ? 0u : high, p);
    const Interval farther = opaque_interval(low, around.y, p);
    planes[0] = nearer.near, planes[1] = nearer.far, planes[2] = farther.near, planes[3] = farther.far;
  }
#else
  atomic_or(&mask, slots);
  barrier(CLK_LOCAL_MEM_FENCE);
  planes[2] = as_float(high == 0u || high > ONE_BITS ? 0xffffffffu : mask);
#endif
#endif
  if (item != 0) return;
  for (uint i = 0; i < BOUND_PLANES; ++i) put_bounds(opaque, BOUND_PLANES, i, tx, ty, planes[i], p);
#ifdef BLEND
  const Interval in_front = blend_interval(keys.z, high, p);
  put_bounds(blend, 2, 0, tx, ty, in_front.near, p), put_bounds(blend, 2, 1, tx, ty, in_front.far, p);
#endif
  if (high > ONE_BITS) atomic_inc(counters + 2);
}
