// Lights to the cells of each bin, for CPUs: one work-item takes a bin, gathers its candidates from its region's list,
// narrows them for each quad of 2 x 2 tiles, and tests what is left against each cell, 16 lights at a time. Lists come
// out sorted. Compare: Olsson, Assarsson, "Tiled Shading" (2011); Olsson, Billeter, Assarsson, "Clustered Deferred and
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
// Where room runs out a bin writes nothing; the host reads what was asked for and runs the kernels again with more.
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

static inline void append_lights(global float* to, size_t to_stride, uint n, global const float* from,
                                 size_t from_stride, uint bits) {
#pragma unroll
  for (uint a = 0; a < VIEW_ARRAYS; ++a) {
    if (a == VIEW_FIRST || a == VIEW_LAST) continue;
    append_reals(to + a * to_stride + n, vload16(0, from + a * from_stride), bits);
  }
}

static inline int16 tiles_in_bin(TileRect rect, int x, int y) {
  const int16 x0 = max((rect.first & 0xffff) - x, 0), x1 = min((rect.last & 0xffff) - x, 7);
  const int16 y0 = max((rect.first >> 16) - y, 0), y1 = min((rect.last >> 16) - y, 7);
  const int16 one = 1;
  return ((one << (x1 + 1)) - (one << x0)) | ((one << (y1 + 1)) - (one << y0)) << 8;
}

typedef struct Candidates {
  global float* lights;
  size_t stride;
  uint count;
} Candidates;

// Lights of the region that may touch the bin, in order; *pairs: a bound of the pairs they make with its tiles.
static inline void gather(global const float* list, global const uint* counts, uint runs, int x, int y, const Cell* bin,
                          Candidates* out, uint* pairs, constant CullParams* p) {
  const size_t stride = p->light_stride + 16;
  const uint blocks = p->light_stride / 16;
  const int first = x | y << 16, last = (x + 7) | (y + 7) << 16;
  uint n = 0;
  int16 sum = 0;
  for (uint run = 0; run < runs; ++run) {
    global const float* from = list + (uint)((ulong)blocks * run / runs) * 16;
    const int16 count = (int)counts[run];
    for (int i = 0; i < count.x; i += 16, from += 16) {
      const TileRect rect = {as_int16(vload16(0, from + VIEW_FIRST * stride)), as_int16(vload16(0, from + VIEW_LAST * stride))};
      const int16 keep = rect_meets(rect, first, last) & (i + LANE_INDEX < count) &
                         may_touch_coarsely(load_sphere(from, stride), bin);
      const uint bits = mask_bits(keep);
      if (bits == 0) continue;
      const int16 tiles = tiles_in_bin(rect, x, y);
      append_lights(out->lights, out->stride, n, from, stride, bits);
      append_wholes(out->lights + CANDIDATE_TILES * out->stride + n, tiles, bits);
      sum += keep & as_int16(popcount(as_uint16(tiles & 0xff)) * popcount(as_uint16(tiles & 0xff00)));
      n += popcount(bits);
    }
  }
  const int8 a = sum.lo + sum.hi;
  const int4 b = a.lo + a.hi;
  *pairs = (uint)(b.x + b.y + b.z + b.w);
  out->count = n;
}

// Candidates whose rectangle meets the quad, and which may touch its box.
static inline uint narrow(const Candidates* all, uint columns, uint rows, const Cell* quad, const Candidates* out) {
  uint n = 0;
  for (uint i = 0; i < all->count; i += 16) {
    global const float* from = all->lights + i;
    const int16 tiles = as_int16(vload16(0, from + CANDIDATE_TILES * all->stride));
    const int16 keep = ((tiles & (int)columns) != 0) & ((tiles & (int)rows) != 0) &
                       ((int)i + LANE_INDEX < (int)all->count) & may_touch_coarsely(load_sphere(from, all->stride), quad);
    const uint bits = mask_bits(keep);
    if (bits == 0) continue;
    append_lights(out->lights, out->stride, n, from, all->stride, bits);
    append_wholes(out->lights + CANDIDATE_TILES * out->stride + n, tiles, bits);
    n += popcount(bits);
  }
  return n;
}

kernel void cull_lanes(global const float* lists, global const uint* counts, uint runs, global const float* bounds,
                       global const float2* slices, global float* pool, global index_t* staged, global uint* cell_counts,
                       global uint2* bins, global volatile uint* counters, constant CullParams* p) {
  const uint bin = get_global_id(0), bx = bin % p->bins_x, by = bin / p->bins_x;
  const uint region = by / p->region_bins * p->regions_x + bx / p->region_bins;
  counts += region * runs;
  cell_counts += bin * BIN_SIZE * p->slices;
  uint most = 0;
  for (uint run = 0; run < runs; ++run) most += counts[run];
  bins[bin] = (uint2)(0u);
  for (uint i = 0; i < BIN_SIZE * p->slices; i += 16) vstore16((uint16)(0u), 0, cell_counts + i);

  BinTiles tiles;
  Cell whole_bin, quads[16];
  bounds += bin * BOUND_PLANES * BIN_SIZE;
  make_bin_tiles(bounds, bx, by, &tiles, quads, &whole_bin, p);
  if (most == 0 || whole_bin.near > whole_bin.far) return;

  const uint blocks = most / 16 + 2;
  const uint at = atomic_add(counters, 2 * blocks);
  if ((ulong)at + 2 * blocks > p->pool_blocks) return;
  Candidates all = {pool + (size_t)at * 16 * VIEW_ARRAYS, blocks * 16, 0};
  Candidates few = {all.lights + (size_t)blocks * 16 * VIEW_ARRAYS, blocks * 16, 0};
  uint pairs;
  gather(lists + (size_t)region * VIEW_ARRAYS * (p->light_stride + 16), counts, runs, bx * BIN_TILES, by * BIN_TILES,
         &whole_bin, &all, &pairs, p);
  const ulong wanted = (ulong)pairs * p->slices / 16 + 2;
  const uint units = wanted > 0x0fffffffu ? 0x0fffffffu : (uint)wanted;
  const uint place = atomic_add(counters + 1, units);
  if ((ulong)place + wanted > p->staging_units) return;

  global index_t* list = staged + (size_t)place * 16;
  uint written = 0;
  for (uint quad = 0; quad < 16; ++quad) {
    if (quads[quad].near > quads[quad].far) continue;
    few.count = narrow(&all, 3u << (quad & 3) * 2, 0x300u << (quad >> 2) * 2, &quads[quad], &few);
    if (few.count == 0) continue;
    for (uint slot = quad * 4; slot < quad * 4 + 4; ++slot) {
      const int tile = (int)(1u << tile_x_of_slot(slot) | 0x100u << tile_y_of_slot(slot));
      for (uint slice = 0; slice < p->slices; ++slice) {
        TestCell cell;
        if (!pick_test_cell(&tiles, bounds, slot, slice, slices, &cell, p)) continue;
        const uint before = written;
        for (uint i = 0; i < few.count; i += 16) {
          global const float* from = few.lights + i;
          const int16 columns_and_rows = as_int16(vload16(0, from + CANDIDATE_TILES * few.stride));
          const int16 held = ((columns_and_rows & tile) == tile) & ((int)i + LANE_INDEX < (int)few.count);
          uint bits = mask_bits(held & light_may_touch(from, few.stride, &cell, p));
          append_indices(list + written, as_int16(vload16(0, from + VIEW_ID * few.stride)), bits);
          written += popcount(bits);
        }
        cell_counts[slot * p->slices + slice] = written - before;
      }
    }
  }
  bins[bin] = (uint2)(place, written);
}
