// Depth bounds of every tile, for CPUs. A work-item reduces 16 tiles of a row of tiles, four at a time, so
// that it reads long stretches of memory.
//
// depth     floats; rows of the view start depth_row apart from depth_first on
// opaque, blend  as kernels/culling/depth_bounds.h says
// counters  [counter] += tiles with an invalid depth; such a tile spans every distance.
//           [next_counter] = 0, for the next launch
#define LANES 16
#include "kernels/common/one_item.h"
#include "kernels/culling/depth_bounds.h"

#define TILES 16
#define AT_ONCE 4
#define ROWS_A_LOAD (ROW == 8 ? 2 : 1)

static inline uint lowest_lane(uint16 v) {
  const uint8 a = min(v.lo, v.hi);
  const uint4 b = min(a.lo, a.hi);
  const uint2 c = min(b.lo, b.hi);
  return min(c.x, c.y);
}
static inline uint highest_lane(uint16 v) { return ~lowest_lane(~v); }

// 16 keys of a tile: of one row, or of two where rows are shorter. The last of an
// odd number of rows is read twice.
static inline uint16 load_keys(global const uint* depth, uint row, uint rows, uint stride) {
#if ROW == 8
  global const uint* other = depth + (size_t)min(row + 1, rows - 1) * stride;
  return KEY((uint16)(vload8(0, depth + (size_t)row * stride), vload8(0, other)));
#else
  return KEY(vload16(0, depth + (size_t)row * stride));
#endif
}

// Least key minus 1, which turns the key 0 (no surface) into the greatest number and so leaves
// it out; greatest key; least key.
typedef struct Keys {
  uint low1[TILES], high[TILES], lowest[TILES];
} Keys;

static inline void reduce_tiles(global const uint* depth, uint stride, uint rows, uint first, Keys* keys) {
  uint16 low[AT_ONCE], high[AT_ONCE], lowest[AT_ONCE];
#pragma unroll
  for (int t = 0; t < AT_ONCE; ++t) {
    low[t] = lowest[t] = (uint16)(0xffffffffu);
    high[t] = (uint16)(0u);
  }
  for (uint y = 0; y < rows; y += ROWS_A_LOAD) {
#pragma unroll
    for (int t = 0; t < AT_ONCE; ++t) {
      for (uint x = 0; x < ROW; x += 16) {
        const uint16 key = load_keys(depth + t * ROW + x, y, rows, stride);
        low[t] = min(low[t], key - 1u);
        high[t] = max(high[t], key);
#ifdef BLEND
        lowest[t] = min(lowest[t], key);
#endif
      }
    }
  }
#pragma unroll
  for (int t = 0; t < AT_ONCE; ++t) {
    keys->low1[first + t] = lowest_lane(low[t]);
    keys->high[first + t] = highest_lane(high[t]);
    keys->lowest[first + t] = lowest_lane(lowest[t]);
  }
}

// A tile cut by the view's right edge.
static inline void reduce_cut_tile(global const uint* depth, uint stride, uint rows, uint columns, uint t,
                                   Keys* keys) {
  uint low1 = 0xffffffffu, high = 0u, lowest = 0xffffffffu;
  for (uint y = 0; y < rows; ++y, depth += stride) {
    for (uint x = 0; x < columns; ++x) {
      const uint key = KEY(depth[x]);
      low1 = min(low1, key - 1u);
      high = max(high, key);
      lowest = min(lowest, key);
    }
  }
  keys->low1[t] = low1;
  keys->high[t] = high;
  keys->lowest[t] = lowest;
}

#ifdef SECOND_LOOK
// Up to 16 values from column x on, the rest 0: nothing there.
static inline uint16 keys_from(global const uint* depth, uint x, uint columns) {
  uint keys[16];
  for (uint i = 0; i < 16; ++i) keys[i] = x + i < columns ? KEY(depth[x + i]) : 0u;
  return vload16(0, keys);
}

// Calls BODY(key) on all keys of a tile, 16 at a time.
#define FOR_KEYS(BODY)                                          \
  if (columns == ROW) {                                         \
    for (uint y = 0; y < rows; y += ROWS_A_LOAD)                \
      for (uint x = 0; x < ROW; x += 16) {                      \
        BODY(load_keys(depth + x, y, rows, stride))             \
      }                                                         \
  } else {                                                      \
    for (uint y = 0; y < rows; ++y)                             \
      for (uint x = 0; x < columns; x += 16) {                  \
        BODY(keys_from(depth + (size_t)y * stride, x, columns)) \
      }                                                         \
  }

// Least key at or above the cut, and greatest below it.
static inline uint2 keys_around(global const uint* depth, uint stride, uint rows, uint columns, uint cut) {
  uint16 above = (uint16)(0xffffffffu), below = (uint16)(0u);
#define AROUND(keys)                                            \
  const uint16 key = keys;                                      \
  above = min(above, key >= cut ? key : (uint16)(0xffffffffu)); \
  below = max(below, key < cut ? key : (uint16)(0u));
  FOR_KEYS(AROUND)
  return (uint2)(lowest_lane(above), highest_lane(below));
}

// The bits of the tile's interval that hold a surface.
static inline uint occupied_bits(global const uint* depth, uint stride, uint rows, uint columns, float near,
                                 float far, constant CullParams* p) {
  uint16 mask = (uint16)(0u);
#define OCCUPY(keys)       \
  const uint16 key = keys; \
  mask |= key != (uint16)(0u) ? mask_of_key(key, near, far, p) : (uint16)(0u);
  FOR_KEYS(OCCUPY)
  const uint8 a = mask.lo | mask.hi;
  const uint4 b = a.lo | a.hi;
  return b.x | b.y | b.z | b.w;
}
#endif

kernel ONE_ITEM void depth_bounds(global const uint* depth, global float* opaque, global float* blend,
                                  global volatile uint* counters, uint counter, uint next_counter,
                                  constant CullParams* p) {
  ASSUME_ONE_ITEM;
  const uint tx0 = get_global_id(0) * TILES, ty = get_global_id(1), stride = p->depth_row;
  const uint rows = min((uint)TILE, p->height - ty * TILE), tiles = min((uint)TILES, p->tiles_x - tx0);
  global const uint* first = depth + p->depth_first + (size_t)ty * TILE * stride + tx0 * ROW;
  if (get_global_id(0) == 0 && ty == 0) counters[next_counter] = 0;
  Keys keys;
  for (uint t = 0; t < TILES; ++t) keys.low1[t] = keys.lowest[t] = keys.high[t] = 0;
  for (uint t = 0; t < tiles;) {
    if (t + AT_ONCE <= tiles && (tx0 + t + AT_ONCE) * TILE <= p->width) {
      reduce_tiles(first + t * ROW, stride, rows, t, &keys);
      t += AT_ONCE;
    } else {
      reduce_cut_tile(first + t * ROW, stride, rows, min((uint)TILE, p->width - (tx0 + t) * TILE) * SAMPLES,
                      t, &keys);
      ++t;
    }
  }
  const uint16 low = vload16(0, keys.low1) + 1u, high = vload16(0, keys.high);
  const Interval all = opaque_interval(low, high, p);
  float planes[4][TILES];
  vstore16(all.near, 0, planes[0]);
  vstore16(all.far, 0, planes[1]);
#if DEPTH_MODE == DEPTH_HALFZ || DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  const float16 middle = 0.5f * (all.near + all.far);
#endif
#if DEPTH_MODE == DEPTH_HALFZ
  const int16 some = all.near <= all.far;
  vstore16(some ? middle : all.far, 0, planes[1]);
  vstore16(some ? middle : all.near, 0, planes[2]);
  vstore16(all.far, 0, planes[3]);
#endif
#ifdef SECOND_LOOK
  uint found[2][TILES];
  const float16 nears = all.near, fars = all.far;
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  uint cuts[TILES];
  vstore16(max(KEY(AS_BITS(depth_of_distance(middle, p))), (uint16)(1u)), 0, cuts);  // 0: nothing there
#endif
  for (uint t = 0; t < TILES; ++t) {
    found[0][t] = 0xffffffffu;
    found[1][t] = 0u;
    if (t >= tiles || keys.high[t] == 0u || keys.high[t] > ONE_BITS) continue;
    const uint columns = min((uint)TILE, p->width - (tx0 + t) * TILE) * SAMPLES;
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
    const uint2 around = keys_around(first + t * ROW, stride, rows, columns, cuts[t]);
    found[0][t] = around.x;
    found[1][t] = around.y;
#else
    if (planes[1][t] == FAR_AWAY) continue;  // every distance: every bit
    found[0][t] = occupied_bits(first + t * ROW, stride, rows, columns, planes[0][t], planes[1][t], p);
#endif
  }
#if DEPTH_MODE == DEPTH_HALFZ_MODIFIED
  const uint16 above = vload16(0, found[0]), below = vload16(0, found[1]);
  // A side without a key is empty; a tile with an invalid depth keeps its whole interval.
  const int16 invalid = high > (uint16)(ONE_BITS);
  const Interval nearer = opaque_interval(above, above == (uint16)(0xffffffffu) ? (uint16)(0u) : high, p);
  const Interval farther = opaque_interval(low, below, p);
  vstore16(invalid ? nears : nearer.near, 0, planes[0]);
  vstore16(invalid ? fars : nearer.far, 0, planes[1]);
  vstore16(farther.near, 0, planes[2]);
  vstore16(farther.far, 0, planes[3]);
#else
  for (uint t = 0; t < TILES; ++t) planes[2][t] = as_float(found[0][t]);
#endif
#endif
#ifdef BLEND
  const Interval in_front = blend_interval(vload16(0, keys.lowest), high, p);
  float blend_planes[2][TILES];
  vstore16(in_front.near, 0, blend_planes[0]);
  vstore16(in_front.far, 0, blend_planes[1]);
#endif
  for (uint t = 0; t < tiles; ++t) {
    for (uint i = 0; i < BOUND_PLANES; ++i) put_bounds(opaque, BOUND_PLANES, i, tx0 + t, ty, planes[i][t], p);
#ifdef BLEND
    for (uint i = 0; i < 2; ++i) put_bounds(blend, 2, i, tx0 + t, ty, blend_planes[i][t], p);
#endif
    if (keys.high[t] > ONE_BITS) atomic_inc(counters + counter);
  }
}
