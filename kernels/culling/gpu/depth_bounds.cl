// Depth bounds of every tile, for GPUs. A work-group takes GROUP neighbouring columns of a row of tiles, one
// column an item, so that each item has TILE loads in flight and memory is read in long stretches. Then one
// item finishes a tile. Same contract, arguments and bytes as culling/cpu/depth_bounds.cl.
// -DGROUP  items a group, a power of two (default 256)
#define LANES 1
#include "kernels/culling/depth_bounds.h"

#ifndef GROUP
#define GROUP 256
#endif
#define WIDTH (ROW < GROUP ? ROW : GROUP)  // items of a tile
#define TILES (GROUP / WIDTH)              // tiles per group
// A word between tiles: items that each read their own tile use other banks.
#define PLACE(i) ((i) + (i) / WIDTH)

// Calls BODY(key) on every key of this item: its columns down the rows of tiles from `strip` on. Past the
// view's right and upper edges the last column and row count again, which changes no minimum and no maximum.
#define FOR_KEYS(BODY)                                                               \
  for (uint x = item; x < TILES * ROW; x += GROUP) {                                 \
    global const uint* column = strip + min(tx0 * ROW + x, p->width * SAMPLES - 1u); \
    _Pragma("unroll 16") for (uint y = 0; y < TILE; ++y) {                           \
      const uint key = KEY(column[(size_t)min(y, last_row) * p->depth_row]);         \
      BODY                                                                           \
    }                                                                                \
  }

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void depth_bounds(
    global const uint* depth, global float* opaque, global float* blend, global volatile uint* counters,
    uint counter, uint next_counter, constant CullParams* p) {
  local uint lows[PLACE(GROUP)], highs[PLACE(GROUP)], lowests[PLACE(GROUP)];
  const uint item = get_local_id(0), tx0 = get_group_id(0) * TILES, tx = tx0 + item, ty = get_group_id(1);
  const bool writes = item < TILES && tx < p->tiles_x;
  const uint last_row = min((uint)TILE, p->height - ty * TILE) - 1u, from = PLACE(item * WIDTH);
  global const uint* strip = depth + p->depth_first + (size_t)ty * TILE * p->depth_row;
  if (get_global_id(0) == 0 && ty == 0) counters[next_counter] = 0;
  // Least key minus 1, which leaves out the key 0 (no surface); greatest key; least key.
  uint low = 0xffffffffu, high = 0u, lowest = 0xffffffffu;
  FOR_KEYS(low = min(low, key - 1u); high = max(high, key); lowest = min(lowest, key);)
  lows[PLACE(item)] = low;
  highs[PLACE(item)] = high;
  lowests[PLACE(item)] = lowest;
  barrier(CLK_LOCAL_MEM_FENCE);
  low = lowest = 0xffffffffu;
  high = 0u;
  for (uint i = 0; writes && i < WIDTH; ++i) {
    low = min(low, lows[from + i]);
    high = max(high, highs[from + i]);
    lowest = min(lowest, lowests[from + i]);
  }
  low += 1u;
  const Interval all = opaque_interval(low, high, p);
  float planes[4] = {all.near, all.far, FAR_AWAY, -FAR_AWAY};
#if DEPTH_MODE == DEPTH_HALFZ || DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  const float middle = 0.5f * (all.near + all.far);
#endif
#if DEPTH_MODE == DEPTH_HALFZ
  if (all.near <= all.far) {
    planes[1] = planes[2] = middle;
    planes[3] = all.far;
  }
#endif
#ifdef SECOND_LOOK
  const uint tile = item / WIDTH;
  barrier(CLK_LOCAL_MEM_FENCE);  // lows and highs are free again
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  // Least key at or above the cut, and greatest below it. A side without a key is empty; a tile with an
  // invalid depth keeps its whole interval.
  local uint cuts[TILES];
  if (item < TILES) cuts[item] = max(KEY(as_uint(depth_of_distance(middle, p))), 1u);  // 0: nothing there
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint cut = cuts[tile];
  uint above = 0xffffffffu, below = 0u;
  FOR_KEYS(above = min(above, key >= cut ? key : 0xffffffffu); below = max(below, key < cut ? key : 0u);)
  lows[PLACE(item)] = above;
  highs[PLACE(item)] = below;
  barrier(CLK_LOCAL_MEM_FENCE);
  above = 0xffffffffu;
  below = 0u;
  for (uint i = 0; writes && i < WIDTH; ++i) {
    above = min(above, lows[from + i]);
    below = max(below, highs[from + i]);
  }
  if (high <= ONE_BITS) {
    const Interval nearer = opaque_interval(above, above == 0xffffffffu ? 0u : high, p);
    const Interval farther = opaque_interval(low, below, p);
    planes[0] = nearer.near;
    planes[1] = nearer.far;
    planes[2] = farther.near;
    planes[3] = farther.far;
  }
#else
  local float nears[TILES], fars[TILES];
  local uint masks[TILES];
  if (item < TILES) {
    nears[item] = all.near;
    fars[item] = all.far;
    masks[item] = 0u;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  const float near = nears[tile], far = fars[tile];
  uint slots = 0u;
  FOR_KEYS(if (key != 0u) slots |= mask_of_key(key, near, far, p);)
  atomic_or(&masks[tile], slots);
  barrier(CLK_LOCAL_MEM_FENCE);
  if (writes)
    planes[2] = as_float(high == 0u || high > ONE_BITS || all.far == FAR_AWAY ? 0xffffffffu : masks[item]);
#endif
#endif
  if (!writes) return;
  for (uint i = 0; i < BOUND_PLANES; ++i) put_bounds(opaque, BOUND_PLANES, i, tx, ty, planes[i], p);
#ifdef BLEND
  const Interval in_front = blend_interval(lowest, high, p);
  put_bounds(blend, 2, 0, tx, ty, in_front.near, p);
  put_bounds(blend, 2, 1, tx, ty, in_front.far, p);
#endif
  if (high > ONE_BITS) atomic_inc(counters + counter);
}
