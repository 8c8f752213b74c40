// Lights to the cells of each bin, for CPUs: one work-item takes bins, gathers the lights of one at a time from its region's
// list, narrows them for each block of 4 x 4 tiles where they are many, and for each quad of 2 x 2, and tests what is left
// against each cell, 16 lights at a time. Lists come out sorted. Compare: Olsson, Assarsson, "Tiled Shading" (2011);
// Olsson, Billeter, Assarsson, "Clustered Deferred and Forward Shading" (2012) where there are slices.
//
// records, lists, counts  as project_lights_lanes.cl writes them, `runs` counts a region
// step           quads of bins from one to the next that is taken, no factor of their number in common: each thread's
//                part of the work-items then lies all over the screen
// bounds         as depth_bounds_lanes.cl writes them
// slices         where there are some: as kernels/common/bin_cells.h says
// pool           room for candidates, handed out in blocks of 16 lights: how many were asked for is in counters[0]
// staged         room for each bin's lists, handed out in units of 16 indices: counters[1]
// cell_counts    a bin's cells: BIN_SIZE slots, slices each
// bins           uint2 a bin: where its lists lie in `staged`, in units, and how many indices they hold
//
// Where room runs out a bin writes nothing and sets counters[3]; the host reads what was asked for and runs the kernels
// again with more.
#define LANES 16
#include "kernels/common/bin_tiles.h"
#include "kernels/common/candidates.h"

#ifdef INDEX_32
typedef uint index_t;
#define append_indices append_uints
#else
typedef ushort index_t;
#define append_indices append_ushorts
#endif

static inline uint append_ids(global index_t* to, global const float* ids, uint bits) {
  append_indices(to, as_int16(vload16(0, ids)), bits);
  return popcount(bits);
}

// The indices of the lights in a region, in parts, one a run of project_lights_lanes.cl.
typedef struct RegionLights {
  global const uint* tiles;
  size_t stride;  // from tiles to spans, and on to indices
  global const uint* counts;
  uint runs, blocks;  // of 16 lights, over all runs
} RegionLights;

// The lights that meet what the bin asks, in order. The last of them fills the list up to a multiple of 16.
static inline uint select_lights(RegionLights all, BinAsks asks, global uint* ids) {
  uint n = 0;
  for (uint run = 0; run < all.runs; ++run) {
    global const uint* tiles = all.tiles + (uint)((ulong)all.blocks * run / all.runs) * 16;
    const int count = (int)all.counts[run];
    for (int i = 0; i < count; i += 16, tiles += 16) {
      const int16 meets = meets_bin(vload16(0, tiles), vload16(0, tiles + all.stride), asks);
      const uint bits = mask_bits(meets & (i + LANE_INDEX < count));
      append_uints(ids + n, as_int16(vload16(0, tiles + 2 * all.stride)), bits);
      n += popcount(bits);
    }
  }
  for (uint i = n; i % 16 != 0; ++i) ids[i] = ids[n - 1];
  return n;
}

// Of the lights `ids` those that may touch the bin's box, in order; *pairs: a bound of the pairs they make with its tiles.
static inline uint gather(global const uint* ids, uint count, global const float* records, int x, int y, const Cell* bin,
                          Candidates out, ulong* pairs) {
  uint n = 0;
  int16 sum = 0;
  for (uint i = 0; i < count; i += 16) {
    const LightRecords l = load_records(records, ids + i);
    const int16 keep = may_touch_coarsely(l.sphere, bin) & ((int)i + LANE_INDEX < (int)count);
    const uint bits = mask_bits(keep);
    if (bits == 0) continue;
    int16 pairs_each;
    const int16 tiles = tiles_in_bin(l.tiles, x, y, &pairs_each);
    n += append_records(out.lights + n, out.stride, l, tiles, ids + i, records, bits);
    sum += keep & pairs_each;
  }
  const uint16 lanes = as_uint16(sum);  // each below 2^32, with fewer than 2^30 lights
  const ulong8 a = convert_ulong8(lanes.lo) + convert_ulong8(lanes.hi);
  const ulong4 b = a.lo + a.hi;
  *pairs = b.x + b.y + b.z + b.w;
  return n;
}

// Candidates that share a tile with `side` x `side` tiles from (x, y) of the bin on, and may touch their box.
static inline uint narrow(const Candidates* all, uint x, uint y, uint side, const Cell* box, global float* out) {
  const int columns = (int)(((1u << side) - 1u) << x), rows = (int)(((1u << side) - 1u) << (y + 8));
  const Cell b = *box;
  uint n = 0;
  for (uint i = 0; i < all->count; i += 16) {
    global const float* from = all->lights + i;
    const int16 tiles = as_int16(vload16(0, from + VIEW_TILES * all->stride));
    const int16 keep = ((tiles & columns) != 0) & ((tiles & rows) != 0) & ((int)i + LANE_INDEX < (int)all->count) &
                       may_touch_coarsely(load_sphere(from, all->stride), &b);
    const uint bits = mask_bits(keep);
    if (bits != 0) n += append_lights(out + n, from, all->stride, bits);
  }
  return n;
}

// The lights of one cell, written to `list`; `tile` is its tile as VIEW_TILES has it. Returns how many.
static inline uint list_cell(const Candidates* few, int tile, const TestCell* cell, global index_t* list,
                             constant CullParams* p) {
  uint n = 0;
  for (uint i = 0; i < few->count; i += 16) {
    global const float* from = few->lights + i;
    const int16 tiles = as_int16(vload16(0, from + VIEW_TILES * few->stride));
    const int16 held = ((tiles & tile) == tile) & ((int)i + LANE_INDEX < (int)few->count);
    const uint bits = mask_bits(held & light_may_touch(from, few->stride, cell, p));
    n += append_ids(list + n, from + VIEW_ID * few->stride, bits);
  }
  return n;
}

#define MOST_UNITS 0x0fffffffu  // of a bin: its indices are counted in 32 bits. With more it has no room, and the host refuses
#define MANY 256  // candidates from which on blocks pay

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

// The lists of a quad's cells from its candidates, one after the other. Returns how many indices they hold.
static inline uint list_quad(const Candidates* few, uint quad, const BinTiles* tiles, global const float* bounds,
                             global const float2* slices, global uint* cell_counts, global index_t* list,
                             constant CullParams* p) {
  const int column = 1 << tile_x_of_slot(quad * 4), row = 0x100 << tile_y_of_slot(quad * 4);
  const int held_by[4] = {column | row, column << 1 | row, column | row << 1, column << 1 | row << 1};
  uint written = 0;
  for (uint slot = quad * 4; slot < quad * 4 + 4 && few->count != 0; ++slot) {
    for (uint slice = 0; slice < SLICE_COUNT; ++slice) {
      TestCell cell;
      if (!pick_test_cell(tiles, bounds, slot, slice, slices, &cell, p)) continue;
      const uint n = list_cell(few, held_by[slot & 3], &cell, list + written, p);
      cell_counts[slot * SLICE_COUNT + slice] = n;
      written += n;
    }
  }
  return written;
}

// rooms: for the indices of a bin's lights, and for its candidates.
static inline void cull_bin(uint bx, uint by, global const float* records, RegionLights lights,
                            global const float* bounds, global const float2* slices, Room* rooms, global float* pool,
                            global index_t* staged, global uint* cell_counts, global uint2* lists,
                            global volatile uint* counters, constant CullParams* p) {
  *lists = (uint2)(0u);
  for (uint i = 0; i < BIN_SIZE * SLICE_COUNT; i += 16) vstore16((uint16)(0u), 0, cell_counts + i);
  uint light_count = 0;
  for (uint run = 0; run < lights.runs; ++run) light_count += lights.counts[run];
  BinTiles tiles;
  Cell whole_bin, blocks[4], quads[16];
  make_bin_tiles(bounds, bx, by, &tiles, quads, blocks, &whole_bin, p);
  if (light_count == 0 || whole_bin.near > whole_bin.far) return;

  if (!make_room(&rooms[0], light_count / (16 * VIEW_ARRAYS) + 2, pool, counters, p)) return;
  global uint* ids = (global uint*)rooms[0].at;
  const uint in_region_x = bx % p->region_bins * BIN_TILES, in_region_y = by % p->region_bins * BIN_TILES;
  const uint count = select_lights(lights, asks_of_bin(in_region_x, in_region_y, &whole_bin), ids);
  const uint blocks_each = (count / 16 + 2) | 1u;  // odd: arrays a power of two apart would collide in the cache
  if (!make_room(&rooms[1], 4 * blocks_each, pool, counters, p)) return;
  const size_t stride = blocks_each * 16, step = stride * VIEW_ARRAYS;
  global float* candidates = rooms[1].at;
  Candidates all = {candidates, stride, 0}, some = {candidates + step, stride, 0};
  Candidates few[2] = {{candidates + 2 * step, stride, 0}, {candidates + 3 * step, stride, 0}};
  ulong pairs;
  all.count = gather(ids, count, records, bx * BIN_TILES, by * BIN_TILES, &whole_bin, all, &pairs);
  const ulong wanted = pairs * SLICE_COUNT / 16 + 2;
  const uint units = wanted > MOST_UNITS ? MOST_UNITS : (uint)wanted;
  const uint place = atomic_add(counters + 1, units);
  if (wanted > MOST_UNITS || (ulong)place + units > p->staging_units) {
    counters[3] = 1u;
    return;
  }

  global index_t* list = staged + (size_t)place * 16;
  const bool many = all.count > MANY;
  uint written = 0;
  // A quad is listed after the next one is narrowed: what was just stored in pieces is slow to load as a whole.
  for (uint quad = 0; quad <= 16; ++quad) {
    if (quad < 16) {
      const uint x = tile_x_of_slot(quad * 4), y = tile_y_of_slot(quad * 4);
      if (quad % 4 == 0 && many) some.count = narrow(&all, x, y, 4, &blocks[quad / 4], some.lights);
      const bool shown = quads[quad].near <= quads[quad].far;
      few[quad & 1].count = shown ? narrow(many ? &some : &all, x, y, 2, &quads[quad], few[quad & 1].lights) : 0u;
    }
    if (quad > 0) {
      written += list_quad(&few[~quad & 1], quad - 1, &tiles, bounds, slices, cell_counts, list + written, p);
    }
  }
  *lists = (uint2)(place, written);
}

kernel void cull_lanes(global const float* records, global const uint* lists, global const uint* counts, uint runs,
                       uint step, global const float* bounds, global const float2* slices, global float* pool,
                       global index_t* staged, global uint* cell_counts, global uint2* bins,
                       global volatile uint* counters, constant CullParams* p) {
  Room rooms[2] = {{0, 0u}, {0, 0u}};
  const size_t stride = p->light_stride + 16;
  const uint across = (p->bins_x + 1) / 2, down = (p->bins_y + 1) / 2;
  // Four neighbors at a time: they share most of their lights.
  for (uint turn = get_global_id(0); turn < across * down; turn += get_global_size(0)) {
    const uint quad = (uint)((ulong)turn * step % (across * down));
    for (uint i = 0; i < 4; ++i) {
      const uint bx = quad % across * 2 + (i & 1), by = quad / across * 2 + (i >> 1), bin = by * p->bins_x + bx;
      if (bx >= p->bins_x || by >= p->bins_y) continue;
      const uint region = by / p->region_bins * p->regions_x + bx / p->region_bins;
      const RegionLights lights = {lists + region * 3 * stride, stride, counts + region * runs, runs,
                                   p->light_stride / 16};
      cull_bin(bx, by, records, lights, bounds + bin * BOUND_PLANES * BIN_SIZE, slices, rooms, pool, staged,
               cell_counts + bin * BIN_SIZE * SLICE_COUNT, bins + bin, counters, p);
    }
  }
}
