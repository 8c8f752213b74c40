// All tiles of a bin at once, 16 at a time, with the boxes around each quad of 2 x 2 tiles, each
// block of 4 x 4, and all: for CPUs.
#pragma once

#include "kernels/culling/bin_cells.h"

typedef struct BinTiles {
  float near[INTERVALS][BIN_SIZE], far[INTERVALS][BIN_SIZE];
  float box_x0[INTERVALS][BIN_SIZE], box_x1[INTERVALS][BIN_SIZE];
  float box_y0[INTERVALS][BIN_SIZE], box_y1[INTERVALS][BIN_SIZE];
#if CULL_TEST == CULL_EXACT || defined(SLICES)
  float x0[BIN_SIZE], x1[BIN_SIZE], y0[BIN_SIZE], y1[BIN_SIZE];
#endif
} BinTiles;

// Boxes, one a lane.
typedef struct Span {
  float16 near, far, x0, x1, y0, y1;
} Span;

static inline Span no_span(void) {
  const Span s = {NOTHING, -NOTHING, NOTHING, -NOTHING, NOTHING, -NOTHING};
  return s;
}

static inline Span join(Span a, Span b) {
  const Span s = {lane_min(a.near, b.near), lane_max(a.far, b.far), lane_min(a.x0, b.x0),
                  lane_max(a.x1, b.x1),     lane_min(a.y0, b.y0),   lane_max(a.y1, b.y1)};
  return s;
}

#define SWAP_SPAN(a, order) \
  { a.near.order, a.far.order, a.x0.order, a.x1.order, a.y0.order, a.y1.order }

static inline Span join_quads(Span a) {  // each lane becomes its quad's
  const Span next = SWAP_SPAN(a, s1032547698badcfe);
  const Span pair = join(a, next);
  const Span other = SWAP_SPAN(pair, s23016745ab89efcd);
  return join(pair, other);
}

static inline Span join_all(Span quads) {
  const Span next = SWAP_SPAN(quads, s45670123cdef89ab);
  const Span pair = join(quads, next);
  const Span other = SWAP_SPAN(pair, s89abcdef01234567);
  return join(pair, other);
}

static inline void store_cells(Span s, Cell* cells, uint every, uint n) {
  float values[6][16];
  vstore16(s.near, 0, values[0]);
  vstore16(s.far, 0, values[1]);
  vstore16(s.x0, 0, values[2]);
  vstore16(s.x1, 0, values[3]);
  vstore16(s.y0, 0, values[4]);
  vstore16(s.y1, 0, values[5]);
  for (uint i = 0; i < n; ++i) {
    const uint lane = i * every;
    cells[i].near = values[0][lane];
    cells[i].far = values[1][lane];
    cells[i].box_x0 = values[2][lane];
    cells[i].box_x1 = values[3][lane];
    cells[i].box_y0 = values[4][lane];
    cells[i].box_y1 = values[5][lane];
  }
}

// quads: 16, blocks: 4; near > far where a quad, a block or the bin holds no surface.
static inline void make_bin_tiles(global const float* bounds, uint bx, uint by, BinTiles* tiles, Cell* quads,
                                  Cell* blocks, Cell* bin, constant CullParams* p) {
  Span all = no_span();
  for (uint k = 0; k < 4; ++k) {
    const int16 slot = (int)(k * 16) + LANE_INDEX;
    const int16 tx = (int)(bx * BIN_TILES) + ((slot & 1) | (slot >> 1 & 2) | (slot >> 2 & 4));
    const int16 ty = (int)(by * BIN_TILES) + ((slot >> 1 & 1) | (slot >> 2 & 2) | (slot >> 3 & 4));
    const TileSides sides = tile_sides(convert_float16(tx), convert_float16(ty), p);
#if CULL_TEST == CULL_EXACT || defined(SLICES)
    vstore16(sides.x0, k, tiles->x0);
    vstore16(sides.x1, k, tiles->x1);
    vstore16(sides.y0, k, tiles->y0);
    vstore16(sides.y1, k, tiles->y1);
#endif
    Span here = no_span();
    for (int i = 0; i < INTERVALS; ++i) {
      const float16 near = vload16(k, bounds + 2 * i * BIN_SIZE),
                    far = vload16(k, bounds + (2 * i + 1) * BIN_SIZE);
      const Box box = box_between(sides, near, far, p);
      vstore16(near, k, tiles->near[i]);
      vstore16(far, k, tiles->far[i]);
      vstore16(box.x0, k, tiles->box_x0[i]);
      vstore16(box.x1, k, tiles->box_x1[i]);
      vstore16(box.y0, k, tiles->box_y0[i]);
      vstore16(box.y1, k, tiles->box_y1[i]);
      const int16 some = near <= far;
      const float16 low = NOTHING, high = -NOTHING;
      const Span span = {some ? near : low,    some ? far : high,   some ? box.x0 : low,
                         some ? box.x1 : high, some ? box.y0 : low, some ? box.y1 : high};
      here = join(here, span);
    }
    const Span joined = join_quads(here), block = join_all(joined);
    store_cells(joined, quads + k * 4, 4, 4);
    store_cells(block, blocks + k, 1, 1);
    all = join(all, block);
  }
  store_cells(all, bin, 1, 1);
}

// Returns whether anything is in the cell.
static inline bool pick_test_cell(const BinTiles* tiles, global const float* bounds, uint slot, uint slice,
                                  global const float2* slices, TestCell* c, constant CullParams* p) {
  bool some = false;
  for (int i = 0; i < INTERVALS; ++i) {
    Cell* cell = &c->parts[i];
    cell->near = tiles->near[i][slot];
    cell->far = tiles->far[i][slot];
#ifdef SLICES
    cell->near = max(cell->near, slices[slice].x);
    cell->far = min(cell->far, slices[slice].y);
    const float x0 = tiles->x0[slot], x1 = tiles->x1[slot], y0 = tiles->y0[slot], y1 = tiles->y1[slot];
    const float n = p->orthographic ? 1.0f : cell->near, f = p->orthographic ? 1.0f : cell->far;
    cell->box_x0 = x0 * n < x0 * f ? x0 * n : x0 * f;
    cell->box_x1 = x1 * n > x1 * f ? x1 * n : x1 * f;
    cell->box_y0 = y0 * n < y0 * f ? y0 * n : y0 * f;
    cell->box_y1 = y1 * n > y1 * f ? y1 * n : y1 * f;
#else
    cell->box_x0 = tiles->box_x0[i][slot];
    cell->box_x1 = tiles->box_x1[i][slot];
    cell->box_y0 = tiles->box_y0[i][slot];
    cell->box_y1 = tiles->box_y1[i][slot];
#endif
#if CULL_TEST == CULL_EXACT
    cell->x0 = tiles->x0[slot];
    cell->x1 = tiles->x1[slot];
    cell->y0 = tiles->y0[slot];
    cell->y1 = tiles->y1[slot];
#endif
    some |= cell->near <= cell->far;
  }
#if DEPTH_MODE == DEPTH_MASK32
  c->mask_near = at_slot(bounds, 0, slot);
  c->mask_far = at_slot(bounds, 1, slot);
  c->mask = as_uint(at_slot(bounds, 2, slot));
#endif
  return some;
}
