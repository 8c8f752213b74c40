// The lights that a bin's cells are tested against: selected from the region's list, then
// narrowed step by step. For CPUs.
#pragma once

#include "kernels/culling/light_records.h"

// -DSURFACE_MASKS  tiles have the masks of their surfaces, and a light is a candidate where it has one
//   light_masks  bits, by light
//   tile_masks   of a bin's tiles, by slot
#ifdef SURFACE_MASKS
static inline int16 masks_of_lights(global const uint* ids, global const uint* light_masks) {
  int masks[16];
  for (uint i = 0; i < 16; ++i) masks[i] = (int)light_masks[ids[i]];
  return vload16(0, masks);
}
static inline uint masks_of_tiles(global const uint* tile_masks, uint count) {
  uint masks = 0;
  for (uint i = 0; i < count; ++i) masks |= tile_masks[i];
  return masks;
}
// The 16 candidates at `from` that have one of these.
static inline uint in_masks(global const float* from, size_t stride, uint masks) {
  return mask_bits((as_int16(vload16(0, from + VIEW_MASKS * stride)) & (int16)((int)masks)) != 0);
}
#else
#define masks_of_tiles(tile_masks, count) 0u
#define in_masks(from, stride, masks) 0xffffu
#endif

typedef struct Candidates {
  global float* lights;  // arrays of kernels/culling/light_arrays.h
  size_t stride;
  uint count;
} Candidates;

// Appends those of the 16 lights at `from` that `bits` keeps. Returns how many.
static inline uint append_lights(global float* to, global const float* from, size_t stride, uint bits) {
#if defined(AVX512) || defined(AVX2)
#pragma unroll
  for (uint a = 0; a < VIEW_ARRAYS; ++a) append_reals(to + a * stride, vload16(0, from + a * stride), bits);
#else
  for (uint left = bits; left; left &= left - 1, ++to) {
    const uint i = lowest_bit(left);
#pragma unroll
    for (uint a = 0; a < VIEW_ARRAYS; ++a) to[a * stride] = from[a * stride + i];
  }
#endif
  return popcount(bits);
}

// The same for 16 records.
static inline uint append_records(global float* to, size_t stride, LightRecords l, int16 tiles, int16 masks,
                                  global const uint* ids, global const float* records, uint bits) {
#if defined(AVX512) || defined(AVX2)
  append_reals(to + VIEW_X * stride, l.sphere.x, bits);
  append_reals(to + VIEW_Y * stride, l.sphere.y, bits);
  append_reals(to + VIEW_D * stride, l.sphere.d, bits);
  append_reals(to + VIEW_R * stride, l.sphere.r, bits);
  append_reals(to + VIEW_TILES * stride, as_float16(tiles), bits);
  append_reals(to + VIEW_ID * stride, as_float16(vload16(0, ids)), bits);
#ifdef SPOTS
  append_reals(to + VIEW_CONE * stride, l.cone.x, bits);
  append_reals(to + (VIEW_CONE + 1) * stride, l.cone.y, bits);
  append_reals(to + (VIEW_CONE + 2) * stride, l.cone.d, bits);
  append_reals(to + (VIEW_CONE + 3) * stride, l.cone.cosine, bits);
#endif
#ifdef SURFACE_MASKS
  append_reals(to + VIEW_MASKS * stride, as_float16(masks), bits);
#endif
#else
  int lanes[16];
  vstore16(tiles, 0, lanes);
#ifdef SURFACE_MASKS
  int own[16];
  vstore16(masks, 0, own);
#endif
  for (uint left = bits; left; left &= left - 1, ++to) {
    const uint i = lowest_bit(left);
    global const float* record = records + ids[i] * (size_t)RECORD;
#pragma unroll
    for (uint a = 0; a < 4; ++a) to[a * stride] = record[a];
    to[VIEW_TILES * stride] = as_float(lanes[i]);
    to[VIEW_ID * stride] = as_float(ids[i]);
#pragma unroll
    for (uint a = VIEW_CONE; a < VIEW_MASKS; ++a) to[a * stride] = record[RECORD_CONE + a - VIEW_CONE];
#ifdef SURFACE_MASKS
    to[VIEW_MASKS * stride] = as_float(own[i]);
#endif
  }
#endif
  return popcount(bits);
}

// The tiles of the bin at (x, y) as VIEW_TILES has them; *count: how many.
static inline int16 tiles_in_bin(TileRect rect, int x, int y, int16* count) {
  // Vectors: with a number beside one, Oclgrind 21.10 reads past it
  const int16 zero = 0, one = 1, seven = 7;
  const int16 x0 = max((rect.first & 0xffff) - x, zero), x1 = min((rect.last & 0xffff) - x, seven);
  const int16 y0 = max((rect.first >> 16) - y, zero), y1 = min((rect.last >> 16) - y, seven);
  *count = (x1 - x0 + 1) * (y1 - y0 + 1);
  return ((one << (x1 + 1)) - (one << x0)) | ((one << (y1 + 1)) - (one << y0)) << 8;
}

// A region's light indices, in one part a run of culling/cpu/project_lights.cl.
typedef struct RegionLights {
  global const uint* tiles;
  size_t stride;  // from tiles to spans, and on to indices
  global const uint* counts;
  uint runs, batches;  // batches: of 16 lights, over all runs
} RegionLights;

// The lights whose ranges overlap the bin's, in order. The last one is repeated up to a multiple of 16.
static inline uint select_lights(RegionLights all, PackedRange range, global uint* ids) {
  uint n = 0;
  for (uint run = 0; run < all.runs; ++run) {
    global const uint* tiles = all.tiles + (uint)((ulong)all.batches * run / all.runs) * 16;
    const int count = (int)all.counts[run];
    for (int i = 0; i < count; i += 16, tiles += 16) {
      const int16 meets = meets_bin(vload16(0, tiles), vload16(0, tiles + all.stride), range);
      const uint bits = mask_bits(meets) & first_lanes((uint)(count - i));
      append_uints(ids + n, as_int16(vload16(0, tiles + 2 * all.stride)), bits);
      n += popcount(bits);
    }
  }
  for (uint i = n; i % 16 != 0; ++i) ids[i] = ids[n - 1];
  return n;
}

// Gathers the lights `ids` that may touch the bin's box, in order. *pairs: an upper bound of their pairs with
// its tiles. masks: of the bin.
static inline uint gather(global const uint* ids, uint count, global const float* records,
                          global const uint* light_masks, int x, int y, const Cell* bin, uint masks,
                          Candidates out, ulong* pairs) {
  uint n = 0;
  int16 sum = 0;
  for (uint i = 0; i < count; i += 16) {
    const LightRecords l = load_records(records, ids + i);
    int16 keep = may_touch_coarsely(l.sphere, bin) & ((int)i + LANE_INDEX < (int)count);
#ifdef SURFACE_MASKS
    const int16 own = masks_of_lights(ids + i, light_masks);
    keep &= (own & (int16)((int)masks)) != 0;
#else
    const int16 own = 0;
#endif
    const uint bits = mask_bits(keep);
    if (bits == 0) continue;
    int16 pairs_each;
    const int16 tiles = tiles_in_bin(l.tiles, x, y, &pairs_each);
    n += append_records(out.lights + n, out.stride, l, tiles, own, ids + i, records, bits);
    sum += keep & pairs_each;
  }
  const uint16 lanes = as_uint16(sum);  // each below 2^32, with fewer than 2^30 lights
  const ulong8 a = convert_ulong8(lanes.lo) + convert_ulong8(lanes.hi);
  const ulong4 b = a.lo + a.hi;
  *pairs = b.x + b.y + b.z + b.w;
  return n;
}

// Candidates that share a tile with the `side` x `side` tiles from (x, y) of the bin on, and may touch their
// box. masks: of these tiles.
static inline uint narrow(const Candidates* all, uint x, uint y, uint side, const Cell* box, uint masks,
                          global float* out) {
  const int columns = (int)(((1u << side) - 1u) << x), rows = (int)(((1u << side) - 1u) << (y + 8));
  const Cell b = *box;
  uint n = 0;
  for (uint i = 0; i < all->count; i += 16) {
    global const float* from = all->lights + i;
    const int16 tiles = as_int16(vload16(0, from + VIEW_TILES * all->stride));
    const uint bits = bits_of_both((tiles & columns) != 0, (tiles & rows) != 0) &
                      mask_bits(may_touch_coarsely(load_sphere(from, all->stride), &b)) &
                      in_masks(from, all->stride, masks) & first_lanes(all->count - i);
    if (bits != 0) n += append_lights(out + n, from, all->stride, bits);
  }
  return n;
}

// Room for candidates. A work-item keeps it from bin to bin, so that it stays in the cache.
typedef struct Room {
  global float* at;
  uint batches;  // batches of 16 lights
} Room;

// Makes it at least `batches` batches large. Returns whether there was room.
static inline bool make_room(Room* room, uint batches, global float* pool, global volatile uint* counters,
                             constant CullParams* p) {
  if (room->batches >= batches) return true;
  const uint at = atomic_add(counters, batches);
  room->at = pool + (size_t)at * 16 * VIEW_ARRAYS;
  room->batches = (ulong)at + batches <= p->pool_batches ? batches : 0u;
  if (room->batches == 0) counters[3] = 1u;
  return room->batches != 0;
}
