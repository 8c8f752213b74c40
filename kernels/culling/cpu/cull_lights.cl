// Lists the lights of each cell, for CPUs. A work-item takes one bin of 8 x 8 tiles after the other: it
// selects the bin's lights from its region's list, narrows them to each quad of 2 x 2 tiles (by blocks of
// 4 x 4 first where they are many), and tests the rest against each cell, 16 lights at a time. Lists come out
// sorted. Olsson, Assarsson, "Tiled Shading" (2011); Olsson, Billeter, Assarsson, "Clustered Deferred and
// Forward Shading" (2012) where there are slices.
//
// records, lists, counts  as culling/cpu/project_lights.cl writes them, `runs` counts a region
// spread         stride through the patches of 2 x 2 bins, coprime to their number: spreads each
//                thread's work-items over the screen
// light_masks   with -DSURFACE_MASKS: of each light, bits (scene/effect_terms.h)
// bounds         as culling/cpu/depth_bounds.cl writes them
// tile_masks    with -DSURFACE_MASKS: of each bin's tiles, in slots, the masks that their surfaces have
//                (culling/tile_masks.cl)
// slices         where there are some: as kernels/culling/bin_cells.h says
// pool           room for candidates in batches of 16 lights; the batches needed are counted in counters[0]
// staged         room for each bin's lists in units of 16 indices; the units needed are counted in
//                counters[1]
// cell_counts    a bin's cells: BIN_SIZE slots, slices each
// bins           uint2 a bin: its first unit in `staged`, and the number of its indices
//
// A bin without room writes nothing and sets counters[3]; the host then reads the counters and runs
// the kernels again with more room.
#define LANES 16
#include "kernels/common/index_type.h"
#include "kernels/common/one_item.h"
#include "kernels/culling/bin_tiles.h"
#include "kernels/culling/candidates.h"

#ifdef INDEX_32
#define append_indices append_uints
#else
#define append_indices append_ushorts
#endif

static inline uint append_ids(global index_t* to, global const float* ids, uint bits) {
  append_indices(to, as_int16(vload16(0, ids)), bits);
  return popcount(bits);
}

// The lights of one cell, written to `list`; `tile` is its tile as VIEW_TILES has it. Returns how many.
static inline uint list_cell(const Candidates* few, int tile, const TestCell* cell, uint masks,
                             global index_t* list, constant CullParams* p) {
  uint n = 0;
  for (uint i = 0; i < few->count; i += 16) {
    global const float* from = few->lights + i;
    const int16 tiles = as_int16(vload16(0, from + VIEW_TILES * few->stride));
    const uint bits = bits_of_both((tiles & tile) == tile, light_may_touch(from, few->stride, cell, p)) &
                      in_masks(from, few->stride, masks) & first_lanes(few->count - i);
    n += append_ids(list + n, from + VIEW_ID * few->stride, bits);
  }
  return n;
}

// The most units of a bin, whose indices are counted in 32 bits. A bin with more gets no room; the host
// refuses.
#define MOST_UNITS 0x0fffffffu
#define MANY 256  // with more candidates, testing blocks before quads pays

// The lists of a quad's cells from its candidates, one after the other. Returns how many indices they hold.
static inline uint list_quad(const Candidates* few, uint quad, const BinTiles* tiles,
                             global const float* bounds, global const uint* tile_masks,
                             global const float2* slices, global uint* cell_counts, global index_t* list,
                             constant CullParams* p) {
  const int column = 1 << tile_x_of_slot(quad * 4), row = 0x100 << tile_y_of_slot(quad * 4);
  const int held_by[4] = {column | row, column << 1 | row, column | row << 1, column << 1 | row << 1};
  uint written = 0;
  for (uint slot = quad * 4; slot < quad * 4 + 4 && few->count != 0; ++slot) {
    for (uint slice = 0; slice < SLICE_COUNT; ++slice) {
      TestCell cell;
      if (!pick_test_cell(tiles, bounds, slot, slice, slices, &cell, p)) continue;
      const uint n =
          list_cell(few, held_by[slot & 3], &cell, masks_of_tiles(tile_masks + slot, 1), list + written, p);
      cell_counts[slot * SLICE_COUNT + slice] = n;
      written += n;
    }
  }
  return written;
}

// rooms: for the indices of a bin's lights, and for its candidates.
static inline void cull_bin(uint bx, uint by, global const float* records, RegionLights lights,
                            global const uint* light_masks, global const float* bounds,
                            global const uint* tile_masks, global const float2* slices, Room* rooms,
                            global float* pool, global index_t* staged, global uint* cell_counts,
                            global uint2* lists, global volatile uint* counters, constant CullParams* p) {
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
  const uint count = select_lights(lights, packed_range_of_bin(in_region_x, in_region_y, &whole_bin), ids);
  const uint batches = (count / 16 + 2) | 1u;  // odd: arrays a power of two apart would collide in the cache
  if (!make_room(&rooms[1], 4 * batches, pool, counters, p)) return;
  const size_t stride = batches * 16, step = stride * VIEW_ARRAYS;
  global float* candidates = rooms[1].at;
  Candidates all = {candidates, stride, 0}, some = {candidates + step, stride, 0};
  Candidates few[2] = {{candidates + 2 * step, stride, 0}, {candidates + 3 * step, stride, 0}};
  ulong pairs;
  all.count = gather(ids, count, records, light_masks, bx * BIN_TILES, by * BIN_TILES, &whole_bin,
                     masks_of_tiles(tile_masks, BIN_SIZE), all, &pairs);
  const ulong wanted = pairs * SLICE_COUNT / 16 + 2;
  const uint units = wanted > MOST_UNITS ? MOST_UNITS : (uint)wanted;
  const uint offset = atomic_add(counters + 1, units);
  if (wanted > MOST_UNITS || (ulong)offset + units > p->staging_units) {
    counters[3] = 1u;
    return;
  }

  global index_t* list = staged + (size_t)offset * 16;
  const bool many = all.count > MANY;
  uint written = 0;
  // A quad's lists are written after the next quad's candidates: a vector load just
  // after narrower stores to it stalls.
  for (uint quad = 0; quad <= 16; ++quad) {
    if (quad < 16) {
      const uint x = tile_x_of_slot(quad * 4), y = tile_y_of_slot(quad * 4);
      if (quad % 4 == 0 && many)
        some.count =
            narrow(&all, x, y, 4, &blocks[quad / 4], masks_of_tiles(tile_masks + quad * 4, 16), some.lights);
      const bool shown = quads[quad].near <= quads[quad].far;
      few[quad & 1].count = shown ? narrow(many ? &some : &all, x, y, 2, &quads[quad],
                                           masks_of_tiles(tile_masks + quad * 4, 4), few[quad & 1].lights)
                                  : 0u;
    }
    if (quad > 0) {
      written += list_quad(&few[~quad & 1], quad - 1, &tiles, bounds, tile_masks, slices, cell_counts,
                           list + written, p);
    }
  }
  *lists = (uint2)(offset, written);
}

kernel ONE_ITEM void cull_lights(global const float* records, global const uint* lists,
                                 global const uint* counts, uint runs, uint spread,
                                 global const uint* light_masks, global const float* bounds,
                                 global const uint* tile_masks, global const float2* slices,
                                 global float* pool, global index_t* staged, global uint* cell_counts,
                                 global uint2* bins, global volatile uint* counters, constant CullParams* p) {
  ASSUME_ONE_ITEM;
  Room rooms[2] = {{0, 0u}, {0, 0u}};
  const size_t stride = p->light_stride + 16;
  const uint across = (p->bins_x + 1) / 2, down = (p->bins_y + 1) / 2;
  // Patches of 2 x 2 bins: neighbours share most of their lights.
  for (uint turn = get_global_id(0); turn < across * down; turn += get_global_size(0)) {
    const uint patch = (uint)((ulong)turn * spread % (across * down));
    for (uint i = 0; i < 4; ++i) {
      const uint bx = patch % across * 2 + (i & 1), by = patch / across * 2 + (i >> 1),
                 bin = by * p->bins_x + bx;
      if (bx >= p->bins_x || by >= p->bins_y) continue;
      const uint region = by / p->region_bins * p->regions_x + bx / p->region_bins;
      const RegionLights lights = {lists + region * 3 * stride, stride, counts + region * runs, runs,
                                   p->light_stride / 16};
      cull_bin(bx, by, records, lights, light_masks, bounds + bin * BOUND_PLANES * BIN_SIZE,
               tile_masks + bin * BIN_SIZE, slices, rooms, pool, staged,
               cell_counts + bin * BIN_SIZE * SLICE_COUNT, bins + bin, counters, p);
    }
  }
}
