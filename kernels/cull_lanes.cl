// Lights to the cells of each bin, for CPUs: one work-item takes a bin, gathers its candidates from its region's list,
// narrows them for each block of 4 x 4 tiles where they are many, and for each quad of 2 x 2, and tests what is left
// against each cell, 16 lights at a time. Lists come out sorted. Compare: Olsson, Assarsson, "Tiled Shading" (2011); Olsson, Billeter, Assarsson, "Clustered Deferred and
// Forward Shading" (2012) where there are slices.
//
// lists, counts  as project_lights_lanes.cl writes them, `runs` counts a region
// bounds         as depth_bounds_lanes.cl writes them
// slices         where there are some: as kernels/common/bin_cells.h says
// pool           room for candidates, handed out in blocks of 16 lights: how many were asked for is in counters[0]
// staged         room for each bin's lists, handed out in units of 16 indices: counters[1]
// cell_counts    a bin's cells: BIN_SIZE slots, slices each
// bins           uint2 a bin: where its lists lie in `staged`, in units, and how many indices they hold
//
// -DBINS: a work-item takes BINS x BINS bins of one region, and first narrows the region's list to them: pays for many
// lights (default 1)
//
// Where room runs out a bin writes nothing and sets counters[3]; the host reads what was asked for and runs the kernels
// again with more.
#define LANES 16
#include "kernels/common/bin_tiles.h"

#ifdef INDEX_32
typedef uint index_t;
#define append_indices append_uints
#else
typedef ushort index_t;
#define append_indices append_ushorts
#endif

// Candidates: the arrays of light_arrays.h, but for the rectangle: bits 0-7 its columns in the bin, 8-15 its rows.
#define CANDIDATE_TILES VIEW_FIRST

// The 16 lights at `from`, those that `bits` keeps, with their tiles.
static inline uint append_lights(global float* to, size_t to_stride, global const float* from, size_t from_stride,
                                 int16 tiles, uint bits) {
#ifdef AVX512
#pragma unroll
  for (uint a = 0; a < VIEW_ARRAYS; ++a) {
    if (a != VIEW_FIRST && a != VIEW_LAST) append_reals(to + a * to_stride, vload16(0, from + a * from_stride), bits);
  }
  append_reals(to + CANDIDATE_TILES * to_stride, as_float16(tiles), bits);
#else
  int lanes[16];
  vstore16(tiles, 0, lanes);
  for (uint left = bits; left; left &= left - 1, ++to) {
    const uint i = lowest_bit(left);
    for (uint a = 0; a < VIEW_ARRAYS; ++a) {
      if (a != VIEW_FIRST && a != VIEW_LAST) to[a * to_stride] = from[a * from_stride + i];
    }
    to[CANDIDATE_TILES * to_stride] = as_float(lanes[i]);
  }
#endif
  return popcount(bits);
}

static inline uint append_array(global float* to, global const float* from, uint bits) {
  append_reals(to, vload16(0, from), bits);
  return popcount(bits);
}

static inline uint append_ids(global index_t* to, global const float* ids, uint bits) {
#ifdef AVX512
  append_indices(to, as_int16(vload16(0, ids)), bits);
#else
  for (uint left = bits; left; left &= left - 1) *to++ = (index_t)as_uint(ids[lowest_bit(left)]);
#endif
  return popcount(bits);
}

static inline int16 tiles_in_bin(TileRect rect, int x, int y, int16* count) {
  const int16 zero = 0, one = 1, seven = 7;  // vectors: with a number beside one, Oclgrind 21.10 reads past it
  const int16 x0 = max((rect.first & 0xffff) - x, zero), x1 = min((rect.last & 0xffff) - x, seven);
  const int16 y0 = max((rect.first >> 16) - y, zero), y1 = min((rect.last >> 16) - y, seven);
  *count = (x1 - x0 + 1) * (y1 - y0 + 1);
  return ((one << (x1 + 1)) - (one << x0)) | ((one << (y1 + 1)) - (one << y0)) << 8;
}

// A list of lights in parts, one a run of project_lights_lanes.cl.
typedef struct Lights {
  global const float* values;
  size_t stride;
  global const uint* counts;  // null: `count` in one part
  uint runs, blocks;          // of 16 lights, over all runs
  uint count;                 // over all runs
} Lights;

#define FIRST_OF_RUN(lights, run) ((uint)((ulong)(lights).blocks * (run) / (lights).runs) * 16)
#define COUNT_OF_RUN(lights, run) ((int)((lights).counts ? (lights).counts[run] : (lights).count))

typedef struct Candidates {
  global float* lights;
  size_t stride;
  uint count;
} Candidates;

// Lights that may touch the bin, in order; *pairs: a bound of the pairs they make with its tiles.
static inline uint gather(Lights all, int x, int y, const Cell* bin, Candidates out, uint* pairs) {
  const size_t stride = all.stride;
  const int first = x | y << 16, last = (x + 7) | (y + 7) << 16;
  uint n = 0;
  int16 sum = 0;
  for (uint run = 0; run < all.runs; ++run) {
    global const float* from = all.values + FIRST_OF_RUN(all, run);
    const int count = COUNT_OF_RUN(all, run);
    for (int i = 0; i < count; i += 16, from += 16) {
      const TileRect rect = {as_int16(vload16(0, from + VIEW_FIRST * stride)), as_int16(vload16(0, from + VIEW_LAST * stride))};
      const int16 meets = rect_meets(rect, first, last) & (i + LANE_INDEX < count);
      if (mask_bits(meets) == 0) continue;
      const int16 keep = meets & may_touch_coarsely(load_sphere(from, stride), bin);
      const uint bits = mask_bits(keep);
      if (bits == 0) continue;
      int16 pairs_each;
      const int16 tiles = tiles_in_bin(rect, x, y, &pairs_each);
      n += append_lights(out.lights + n, out.stride, from, stride, tiles, bits);
      sum += keep & pairs_each;
    }
  }
  const int8 a = sum.lo + sum.hi;
  const int4 b = a.lo + a.hi;
  *pairs = (uint)(b.x + b.y + b.z + b.w);
  return n;
}

// Candidates that share a tile with `side` x `side` tiles from (x, y) of the bin on, and may touch their box.
static inline uint narrow(Candidates all, uint x, uint y, uint side, const Cell* box, global float* out) {
  const int columns = (int)(((1u << side) - 1u) << x), rows = (int)(((1u << side) - 1u) << (y + 8));
  const Cell b = *box;
  uint n = 0;
  for (uint i = 0; i < all.count; i += 16) {
    global const float* from = all.lights + i;
    const int16 tiles = as_int16(vload16(0, from + CANDIDATE_TILES * all.stride));
    const int16 keep = ((tiles & columns) != 0) & ((tiles & rows) != 0) & ((int)i + LANE_INDEX < (int)all.count) &
                       may_touch_coarsely(load_sphere(from, all.stride), &b);
    const uint bits = mask_bits(keep);
    if (bits != 0) n += append_lights(out + n, all.stride, from, all.stride, tiles, bits);
  }
  return n;
}

// The lights of one cell, written to `list`; `tile` is its tile as CANDIDATE_TILES has it. Returns how many.
static inline uint list_cell(Candidates few, int tile, const TestCell* cell, global index_t* list, constant CullParams* p) {
  uint n = 0;
  for (uint i = 0; i < few.count; i += 16) {
    global const float* from = few.lights + i;
    const int16 tiles = as_int16(vload16(0, from + CANDIDATE_TILES * few.stride));
    const int16 held = ((tiles & tile) == tile) & ((int)i + LANE_INDEX < (int)few.count);
    const uint bits = mask_bits(held & light_may_touch(from, few.stride, cell, p));
    n += append_ids(list + n, from + VIEW_ID * few.stride, bits);
  }
  return n;
}

#define MANY 256  // candidates from which on blocks pay
#ifndef BINS
#define BINS 1
#endif

// Room for candidates that a work-item keeps from bin to bin: what it wrote for one is still in its cache for the next.
typedef struct Room {
  global float* at;
  uint blocks;  // of 16 lights
} Room;

// Makes it `blocks` blocks at least. Returns whether there was room.
static inline bool make_room(Room* room, uint blocks, global float* pool, global volatile uint* counters,
                             constant CullParams* p) {
  if (room->blocks >= blocks) return true;
  const uint at = atomic_add(counters, blocks);
  room->at = pool + (size_t)at * 16 * VIEW_ARRAYS;
  room->blocks = (ulong)at + blocks <= p->pool_blocks ? blocks : 0u;
  if (room->blocks == 0) counters[3] = 1u;
  return room->blocks != 0;
}

#if BINS > 1
// The lights whose rectangle meets tiles x, y, ... of BINS x BINS bins, in order.
static inline uint select_lights(Lights all, int x, int y, global float* to, size_t to_stride) {
  const int first = x | y << 16, last = (x + BINS * (int)BIN_TILES - 1) | (y + BINS * (int)BIN_TILES - 1) << 16;
  uint n = 0;
  for (uint run = 0; run < all.runs; ++run) {
    global const float* from = all.values + FIRST_OF_RUN(all, run);
    const int count = COUNT_OF_RUN(all, run);
    for (int i = 0; i < count; i += 16, from += 16) {
      const TileRect rect = {as_int16(vload16(0, from + VIEW_FIRST * all.stride)),
                             as_int16(vload16(0, from + VIEW_LAST * all.stride))};
      const uint bits = mask_bits(rect_meets(rect, first, last) & (i + LANE_INDEX < count));
      if (bits == 0) continue;
      append_lights(to + n, to_stride, from, all.stride, rect.first, bits);
      n += append_array(to + VIEW_LAST * to_stride + n, from + VIEW_LAST * all.stride, bits);
    }
  }
  return n;
}
#endif

static inline void cull_bin(const Lights* lights, uint bin, global const float* bounds, global const float2* slices,
                            Room* room, global float* pool, global index_t* staged, global uint* cell_counts,
                            global uint2* bins, global volatile uint* counters, constant CullParams* p) {
  const uint bx = bin % p->bins_x, by = bin / p->bins_x;
  BinTiles tiles;
  Cell whole_bin, blocks[4], quads[16];
  make_bin_tiles(bounds, bx, by, &tiles, quads, blocks, &whole_bin, p);
  if (lights->count == 0 || whole_bin.near > whole_bin.far) return;

  const uint blocks_each = (lights->count / 16 + 2) | 1u;  // odd: arrays a power of two apart would collide in the cache
  if (!make_room(room, 3 * blocks_each, pool, counters, p)) return;
  global float* lists = room->at;
  const size_t stride = blocks_each * 16, step = stride * VIEW_ARRAYS;
  Candidates all = {lists, stride, 0}, some = {lists + step, stride, 0}, few = {lists + 2 * step, stride, 0};
  uint pairs;
  all.count = gather(*lights, bx * BIN_TILES, by * BIN_TILES, &whole_bin, all, &pairs);
  const ulong wanted = (ulong)pairs * SLICE_COUNT / 16 + 2;
  const uint units = wanted > 0x0fffffffu ? 0x0fffffffu : (uint)wanted;
  const uint place = atomic_add(counters + 1, units);
  if ((ulong)place + wanted > p->staging_units) {
    counters[3] = 1u;
    return;
  }

  global index_t* list = staged + (size_t)place * 16;
  const bool many = all.count > MANY;
  uint written = 0;
  for (uint quad = 0; quad < 16; ++quad) {
    const uint x = tile_x_of_slot(quad * 4), y = tile_y_of_slot(quad * 4);
    if (quad % 4 == 0 && many) some.count = narrow(all, x, y, 4, &blocks[quad / 4], some.lights);
    if (quads[quad].near > quads[quad].far) continue;
    const Candidates wider = {many ? some.lights : all.lights, stride, many ? some.count : all.count};
    few.count = narrow(wider, x, y, 2, &quads[quad], few.lights);
    if (few.count == 0) continue;
    const int column = 1 << x, row = 0x100 << y;
    const int held_by[4] = {column | row, column << 1 | row, column | row << 1, column << 1 | row << 1};
    for (uint slot = quad * 4; slot < quad * 4 + 4; ++slot) {
      for (uint slice = 0; slice < SLICE_COUNT; ++slice) {
        TestCell cell;
        if (!pick_test_cell(&tiles, bounds, slot, slice, slices, &cell, p)) continue;
        const uint n = list_cell(few, held_by[slot & 3], &cell, list + written, p);
        cell_counts[slot * SLICE_COUNT + slice] = n;
        written += n;
      }
    }
  }
  bins[bin] = (uint2)(place, written);
}

// BINS x BINS bins from (bx0, by0) on.
static inline void cull_bins(uint bx0, uint by0, global const float* lists, global const uint* counts, uint runs,
                             global const float* bounds, global const float2* slices, Room* rooms, global float* pool,
                             global index_t* staged, global uint* cell_counts, global uint2* bins,
                             global volatile uint* counters, constant CullParams* p) {
  const uint bx1 = min(bx0 + BINS, p->bins_x), by1 = min(by0 + BINS, p->bins_y);
  const uint region = by0 / p->region_bins * p->regions_x + bx0 / p->region_bins;
  const size_t list_stride = p->light_stride + 16;
  Lights lights = {lists + (size_t)region * VIEW_ARRAYS * list_stride, list_stride, counts + region * runs, runs,
                   p->light_stride / 16, 0};
  for (uint run = 0; run < runs; ++run) lights.count += lights.counts[run];
  for (uint by = by0; by < by1; ++by) {
    for (uint bx = bx0; bx < bx1; ++bx) {
      const uint bin = by * p->bins_x + bx;
      bins[bin] = (uint2)(0u);
      for (uint i = 0; i < BIN_SIZE * SLICE_COUNT; i += 16) {
        vstore16((uint16)(0u), 0, cell_counts + bin * BIN_SIZE * SLICE_COUNT + i);
      }
    }
  }
#if BINS > 1
  const uint blocks = lights.count / 16 + 2;
  if (!make_room(&rooms[1], blocks, pool, counters, p)) return;
  const uint n = select_lights(lights, bx0 * BIN_TILES, by0 * BIN_TILES, rooms[1].at, blocks * 16);
  const Lights fewer = {rooms[1].at, blocks * 16, 0, 1, blocks, n};
  lights = fewer;
#endif
  for (uint by = by0; by < by1; ++by) {
    for (uint bx = bx0; bx < bx1; ++bx) {
      const uint bin = by * p->bins_x + bx;
      cull_bin(&lights, bin, bounds + bin * BOUND_PLANES * BIN_SIZE, slices, &rooms[0], pool, staged,
               cell_counts + bin * BIN_SIZE * SLICE_COUNT, bins, counters, p);
    }
  }
}

kernel void cull_lanes(global const float* lists, global const uint* counts, uint runs, global const float* bounds,
                       global const float2* slices, global float* pool, global index_t* staged, global uint* cell_counts,
                       global uint2* bins, global volatile uint* counters, constant CullParams* p) {
  const uint across = (p->bins_x + BINS - 1) / BINS, down = (p->bins_y + BINS - 1) / BINS;
  Room rooms[2] = {{0, 0u}, {0, 0u}};
  for (uint i = get_global_id(0); i < across * down; i += get_global_size(0)) {
    cull_bins(i % across * BINS, i / across * BINS, lists, counts, runs, bounds, slices, rooms, pool, staged, cell_counts,
              bins, counters, p);
  }
}
