// Candidates of each block of 4 x 4 tiles, in order, and for each candidate and cell of the block a bit:
// listed or not. For GPUs; a work-group of GROUP items takes a block.
//
// views, light_marks  as culling/gpu/project_lights.cl writes them
// light_masks, tile_masks  as in culling/cpu/cull_lights.cl
// bounds    as culling/gpu/depth_bounds.cl writes them
// slices    where there are some: as kernels/culling/bin_cells.h says
// ids       the blocks' candidates, in units of 16; the units needed are counted in counters[0]
// offsets   uint4 a block: its first unit of candidates, their number, its first unit of marks (16 words
//           each; the units needed are counted in counters[1]), 0
// totals    number of indices, a block, 64 bits
// marks     a block's cells (BLOCK_SIZE slots, slices each), a word for each 32 candidates
// cells     uint2 a cell, of which .y: the number of its indices
//
// A block without room writes nothing and sets counters[3]; the host then reads the counters and runs
// the kernels again with more room.
// -DGROUP  items a group, a power of two, 64 at least (default 256)
#ifndef GROUP
#define GROUP 256
#endif
#define LANES 1
#include "kernels/common/group_sums.h"
#include "kernels/culling/bin_cells.h"
#include "kernels/culling/group_grid.h"

#define LIGHT_WORDS 2048  // words of lights' marks handled at once
#define MARK_WORDS 32     // words of candidates, likewise
// With a padding word: items that each read their own cell use different banks.
#define MARK_STRIDE (MARK_WORDS + 1)
#define SPANS 6
#define MOST_MARK_UNITS 0x0fffffffu

typedef struct Block {
  int x, y;  // in tiles
  uint bin_x, bin_y, first_slot;
  global const float* bounds;
  global const float2* slices;
  local TestCell* cells;                        // where tiles have one cell each
  global const uint *light_masks, *tile_masks;  // with -DSURFACE_MASKS; the latter by slot of the block
} Block;

static inline bool holds_something(const TestCell* c) {
  bool some = false;
  for (int i = 0; i < INTERVALS; ++i) some |= c->parts[i].near <= c->parts[i].far;
  return some;
}

static inline bool cell_in_block(const Block* block, uint slot, uint slice, TestCell* c,
                                 constant CullParams* p) {
#ifdef SLICES
  return make_test_cell(block->bounds, block->bin_x, block->bin_y, block->first_slot + slot, slice,
                        block->slices, c, p);
#else
  *c = block->cells[slot];
  return holds_something(c);
#endif
}

// The box around all surfaces of the block's tiles; near > far where there are none. Also fills block->cells.
// spans: near, x0, y0, -far, -x1, -y1 of each tile; their minima are the box.
static inline Cell block_box(const Block* block, local float* spans, constant CullParams* p) {
  const uint item = get_local_id(0);
  if (item < BLOCK_SIZE) {
    const uint slot = block->first_slot + item;
    float least[SPANS] = {NOTHING, NOTHING, NOTHING, NOTHING, NOTHING, NOTHING};
    const TileSides sides =
        tile_sides(block->x + (int)tile_x_of_slot(item), block->y + (int)tile_y_of_slot(item), p);
    for (int i = 0; i < INTERVALS; ++i) {
      const float near = at_slot(block->bounds, 2 * i, slot), far = at_slot(block->bounds, 2 * i + 1, slot);
      if (near > far) continue;
      const Box box = box_between(sides, near, far, p);
      least[0] = min(least[0], near);
      least[1] = min(least[1], box.x0);
      least[2] = min(least[2], box.y0);
      least[3] = min(least[3], -far);
      least[4] = min(least[4], -box.x1);
      least[5] = min(least[5], -box.y1);
    }
    for (int i = 0; i < SPANS; ++i) spans[item * SPANS + i] = least[i];
#ifndef SLICES
    TestCell cell;
    make_test_cell(block->bounds, block->bin_x, block->bin_y, slot, 0, block->slices, &cell, p);
    block->cells[item] = cell;
#endif
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item < SPANS) {
    float least = spans[item];
    for (uint i = 1; i < BLOCK_SIZE; ++i) least = min(least, spans[i * SPANS + item]);
    spans[item] = least;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  Cell c = {spans[0], -spans[3], spans[1], -spans[4], spans[2], -spans[5]};
  return c;
}

// The masks of the block's surfaces; without -DSURFACE_MASKS all.
static inline uint masks_of_block(const Block* block) {
#ifdef SURFACE_MASKS
  uint masks = 0;
  for (uint i = 0; i < BLOCK_SIZE; ++i) masks |= block->tile_masks[i];
  return masks;
#else
  return 0xffffffffu;
#endif
}

// Returns the lights in `bits`, from `first` on, that may touch the block. masks: the block's.
static inline uint touch_block(uint bits, uint first_light, global const float4* views, const Block* block,
                               uint masks, const Cell* box) {
  global const float4* first = views + (size_t)first_light * RECORD;
  uint kept = 0;
  for (; bits; bits &= bits - 1) {
    const uint bit = lowest_bit(bits);
#ifdef SURFACE_MASKS
    if (!(block->light_masks[first_light + bit] & masks)) continue;
#endif
    if (may_touch_coarsely(record_sphere(first + bit * RECORD), box)) kept |= 1u << bit;
  }
  return kept;
}

// Appends the block's candidates to `ids` and returns their number: lights that are marked for its column and
// its row and touch its box. Where these marks are few words, several items share a word.
static inline uint list_candidates(global const uint* column, global const uint* row, uint words,
                                   global const float4* views, const Block* block, const Cell* box,
                                   global uint* ids, local uint* kept, local uint* scratch) {
  const uint item = get_local_id(0), masks = masks_of_block(block);
  uint parts = 1;
  while (parts < 8 && words * parts * 2 <= GROUP) parts *= 2;
  const uint share = 32 / parts;  // bits
  uint n = 0;
  for (uint base = 0; base < words; base += LIGHT_WORDS) {
    const uint some = min((uint)LIGHT_WORDS, words - base), each = (some + GROUP - 1) / GROUP;
    for (uint i = item; i < some; i += GROUP) kept[i] = parts > 1 ? 0u : column[base + i] & row[base + i];
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < some * parts; i += GROUP) {
      const uint w = i / parts, mine = 0xffffffffu >> (32 - share) << i % parts * share;
      const uint bits = parts > 1 ? column[base + w] & row[base + w] & mine : kept[w];
      const uint touching = touch_block(bits, (base + w) * 32, views, block, masks, box);
      if (parts == 1)
        kept[w] = touching;
      else if (touching)
        atomic_or(&kept[w], touching);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    const uint from = min(item * each, some), to = min(from + each, some);
    uint count = 0;
    for (uint i = from; i < to; ++i) count += popcount(kept[i]);
    const uint2 offset = prefix_sum(count, scratch);
    uint k = n + offset.x;
    for (uint i = from; i < to; ++i) {
      for (uint bits = kept[i]; bits; bits &= bits - 1, ++k) ids[k] = (base + i) * 32 + lowest_bit(bits);
    }
    n += offset.y;
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  return n;
}

static inline ViewLight record_light(global const float4* record) {
  ViewLight light;
  light.sphere = record_sphere(record);
#ifdef SPOTS
  const float4 v = record[2];
  light.cone.x = v.x;
  light.cone.y = v.y;
  light.cone.d = v.z;
  light.cone.cosine = v.w;
#endif
  return light;
}

// Sets the bits of candidates `ids` in the marks of the block's cells of one slice; an item
// takes a row of tiles of a light.
static inline void mark_cells(global const uint* ids, uint count, global const float4* views,
                              const Block* block, uint slice, local uint* marks, constant CullParams* p) {
  for (uint i = get_local_id(0); i < count * BLOCK_TILES; i += GROUP) {
    const uint k = i / BLOCK_TILES;
    const int row = (int)(i % BLOCK_TILES);
    global const float4* record = views + (size_t)ids[k] * RECORD;
    const TileRect rect = record_rect(record);
    const ViewLight light = record_light(record);
    if (row < (rect.first >> 16) - block->y || row > (rect.last >> 16) - block->y) continue;
    const int end = min((rect.last & 0xffff) - block->x, (int)BLOCK_TILES - 1);
    for (int x = max((rect.first & 0xffff) - block->x, 0); x <= end; ++x) {
      const uint slot = slot_of_tile((uint)x, (uint)row);
#ifdef SURFACE_MASKS
      if (!(block->light_masks[ids[k]] & block->tile_masks[slot])) continue;
#endif
      TestCell cell;
      if (!cell_in_block(block, slot, slice, &cell, p) || !view_light_may_touch(light, &cell, p)) continue;
      atomic_or(&marks[slot * MARK_STRIDE + k / 32], 1u << k % 32);
    }
  }
}

kernel __attribute__((reqd_work_group_size(GROUP, 1, 1))) void cull_lights(
    global const float4* views, global const uint* light_marks, global const uint* light_masks,
    global const float* bounds, global const uint* tile_masks, global const float2* slices, global uint* ids,
    global uint4* offsets, global ulong* totals, global uint* marks, global uint2* cells,
    global volatile uint* counters, constant CullParams* p) {
  local uint scratch[PREFIX_SCRATCH], kept[LIGHT_WORDS], cell_marks[BLOCK_SIZE * MARK_STRIDE];
  local float spans[SPANS * BLOCK_SIZE];
  local TestCell made[BLOCK_SIZE];
  local uint most, ids_at, marks_at;
  local ulong tile_totals[BLOCK_SIZE];
  const uint index = get_group_id(0), item = get_local_id(0), bin = index / BIN_BLOCKS;
  const Block block = {block_x(index, p),
                       block_y(index, p),
                       bin % p->bins_x,
                       bin / p->bins_x,
                       index % BIN_BLOCKS * BLOCK_SIZE,
                       bounds + bin * BOUND_PLANES * BIN_SIZE,
                       slices,
                       made,
                       light_masks,
                       tile_masks + bin * BIN_SIZE + index % BIN_BLOCKS * BLOCK_SIZE};
  const uint line_words = light_mark_words(p);
  global const uint* column = light_marks + (size_t)(block.x / (int)BLOCK_TILES) * line_words;
  global const uint* row = light_marks + (size_t)(BLOCKS_X(p) + block.y / BLOCK_TILES) * line_words;
  const uint all_words = (p->light_count + 31) / 32;
  uint seen = 0;
  for (uint w = item; w < all_words; w += GROUP) seen += popcount(column[w] & row[w]);
  if (item == 0) most = 0u;
  const Cell box = block_box(&block, spans, p);
  const bool some = box.near <= box.far;
  if (seen) atomic_add(&most, seen);
  barrier(CLK_LOCAL_MEM_FENCE);
  const uint units = some ? (most + 15) / 16 : 0u;
  if (item == 0) ids_at = atomic_add(counters, units);
  barrier(CLK_LOCAL_MEM_FENCE);
  const bool room = (ulong)ids_at + units <= p->pool_batches;
  ids += (size_t)ids_at * 16;
  const uint count =
      list_candidates(column, row, some && room ? all_words : 0u, views, &block, &box, ids, kept, scratch);

  // Marks are counted in 32 bits. A block with more gets no room, and the host refuses.
  const uint words = (count + 31) / 32;
  const ulong wanted = (ulong)words * (BLOCK_SIZE / 16) * p->slices;
  const uint mark_units = (uint)min(wanted, (ulong)MOST_MARK_UNITS);
  const bool countable = wanted <= MOST_MARK_UNITS;
  uint mark_units_at = 0;
  if (item == 0) mark_units_at = atomic_add(counters + 1, mark_units);
  barrier(CLK_GLOBAL_MEM_FENCE);
  ulong tile_total = 0;  // for this item's tile: past 2^32 where 2^22 lights are in each of 64 slices
  for (uint slice = 0; slice < SLICE_COUNT; ++slice) {
    uint listed = 0;
    for (uint base = 0; base < words; base += MARK_WORDS) {
      const uint n = min((uint)MARK_WORDS, words - base);
      for (uint i = item; i < BLOCK_SIZE * MARK_STRIDE; i += GROUP) cell_marks[i] = 0u;
      barrier(CLK_LOCAL_MEM_FENCE);
      mark_cells(ids + base * 32, min(n * 32, count - base * 32), views, &block, slice, cell_marks, p);
      if (item == 0) marks_at = mark_units_at;
      barrier(CLK_LOCAL_MEM_FENCE);
      const bool fits = countable && (ulong)marks_at + mark_units <= p->staging_units;
      global uint* to = marks + (size_t)marks_at * 16 + base;
      for (uint i = item; fits && i < BLOCK_SIZE * n; i += GROUP) {
        to[((size_t)(i / n) * p->slices + slice) * words + i % n] = cell_marks[i / n * MARK_STRIDE + i % n];
      }
      for (uint w = 0; item < BLOCK_SIZE && w < n; ++w)
        listed += popcount(cell_marks[item * MARK_STRIDE + w]);
      barrier(CLK_LOCAL_MEM_FENCE);
    }
    uint cell;
    if (item < BLOCK_SIZE && cell_of(index, item, slice, &cell, p)) cells[cell].y = listed;
    tile_total += listed;
  }
  if (item < BLOCK_SIZE) tile_totals[item] = tile_total;
  barrier(CLK_LOCAL_MEM_FENCE);
  if (item != 0) return;
  for (uint i = 1; i < BLOCK_SIZE; ++i) tile_total += tile_totals[i];
  const bool fits = room && countable && (ulong)mark_units_at + mark_units <= p->staging_units;
  offsets[index] = fits ? (uint4)(ids_at, count, mark_units_at, 0u) : (uint4)(0u);
  totals[index] = fits ? tile_total : 0u;
  if (!fits) counters[3] = 1u;
}
