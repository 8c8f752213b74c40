// Records to the visibility buffer, for CPUs, tile by tile of 64 x 64 pixels, in blocks of 4 x 4 pixels, a
// lane each. Edges are exact: 64 bits at the tile's corner, 32 from there on. See Pineda, "A
// Parallel Algorithm for Polygon Rasterization" (1988); Greene, Kass, Miller, "Hierarchical Z-Buffer
// Visibility" (1993) for the least depth a block.
//
// records, tile_begin, lists, counters  as raster/cpu/raster_setup.cl and raster/cpu/raster_fill.cl write them
// MASK_ARGUMENTS  kernels/raster/raster_masks.h
// triangles  uint a sample, those of a pixel side by side: the nearest triangle, of several equally near ones the
//            highest number; RASTER_NONE
// depths     float a sample, reversed: 0 where no triangle is
#define LANES 16
#include "kernels/common/fetch.h"
#include "kernels/common/interleave.h"
#include "kernels/common/one_item.h"
#include "kernels/common/pack.h"
#include "kernels/raster/raster_masks.h"
#include "kernels/raster/raster_tiles.h"

#define FEW_BLOCKS 9         // up to which blocks are gone through one by one
#define LEAST_DEPTH FLT_MIN  // less is not drawn
#define RECORDS_AHEAD 6      // that many records before its turn a record is fetched into the caches

// A tile's pixels in blocks of 4 x 4, the samples of one after the other, and these in squares of 4 x 4 blocks.
typedef struct Tile {
  float16 depth[256][SAMPLES];
  uint16 triangle[256][SAMPLES];
  float16 least[16];  // depth a block, a square each
} Tile;

typedef struct TileRecord {
  Edge edges[3];
  int sample_c[3][SAMPLES], max_c[3];  // c of each sample, and of the one that lies farthest inside
  int16 in_block[3];                   // each edge's gain from a block's first pixel to each pixel
  int dx, dy;                          // from the anchor to the tile's first pixel's centre, 1/256 pixel
  float z0, zx, zy, z_min, z_max;
  uint triangle, instance;
  int alpha_material;
} TileRecord;

// The tile's first pixel, and what its masks are looked up in.
typedef struct Place {
  int pixel_x, pixel_y;
  MaskSource masks;
} Place;

static inline uint block_place(int x, int y) {
  return (uint)(((y >> 2) * 4 + (x >> 2)) * 16 + (y & 3) * 4 + (x & 3));
}

// A pixel's place in its block, and a block's in its square.
#define LANE_X (LANE_INDEX & 3)
#define LANE_Y (LANE_INDEX >> 2)

static inline float min_lane(float16 v) {
  const float8 a = v.lo < v.hi ? v.lo : v.hi;
  const float4 b = a.lo < a.hi ? a.lo : a.hi;
  const float2 c = b.lo < b.hi ? b.lo : b.hi;
  return c.x < c.y ? c.x : c.y;
}

static inline int edge_gain(Edge e, int x, int y) { return e.a * x + e.b * y; }

// At offsets from the anchor, pixels.
static inline float16 plane_depth(const TileRecord* r, float16 dx, float16 dy) {
  return lane_min(fma((float16)(r->zx), dx, fma((float16)(r->zy), dy, (float16)(r->z0))),
                  (float16)(r->z_max));
}

static inline TileRecord in_tile(global const RasterRecord* r, int pixel_x, int pixel_y) {
  TileRecord t;
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    const int next = k == 2 ? 0 : k + 1;
    t.edges[k] = edge_at(r->x[k], r->y[k], r->x[next], r->y[next], pixel_x, pixel_y);
  }
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    t.in_block[k] = t.edges[k].a * LANE_X + t.edges[k].b * LANE_Y;
    t.max_c[k] = edge_of_samples(t.edges[k]);
#pragma unroll
    for (int s = 0; s < SAMPLES; ++s) t.sample_c[k][s] = edge_of_sample(t.edges[k], s);
  }
  const int2 anchor = anchor_pixel(r->zx, r->zy, r->box_low, r->box_high);
  t.dx = (pixel_x - anchor.x) * 256;
  t.dy = (pixel_y - anchor.y) * 256;
  t.z0 = r->z0;
  t.zx = r->zx;
  t.zy = r->zy;
  t.z_min = r->z_min;
  t.z_max = r->z_max;
  t.triangle = r->triangle;
  t.instance = r->instance;
  t.alpha_material = r->alpha_material;
  return t;
}

// Stores what the samples that are `shown` see. before: what they saw.
static inline __attribute__((always_inline)) void show(const TileRecord* r, uint at, const int16* shown,
                                                       const float16* depth, const float16* before,
                                                       Tile* tile) {
  float16 nearest = FLT_MAX;
#pragma unroll
  for (int s = 0; s < SAMPLES; ++s) {
    const float16 now = shown[s] ? depth[s] : before[s];
    tile->depth[at][s] = now;
    tile->triangle[at][s] = shown[s] ? (uint16)(r->triangle) : tile->triangle[at][s];
    nearest = lane_min(nearest, now);
  }
  ((float*)tile->least)[at] = min_lane(nearest);
}

static inline __attribute__((always_inline)) void draw_block(const TileRecord* r, int block_x, int block_y,
                                                             const Place* place, Tile* tile) {
  const uint at = block_place(block_x, block_y);
  if (r->z_max < ((const float*)tile->least)[at]) return;
  const int x = block_x * 4, y = block_y * 4;
  int16 gain[3];  // each edge's gain from the tile's first pixel
#pragma unroll
  for (int k = 0; k < 3; ++k) gain[k] = r->in_block[k] + edge_gain(r->edges[k], x, y);
#if SAMPLES > 1
  const int16 some = (gain[0] + r->max_c[0]) | (gain[1] + r->max_c[1]) | (gain[2] + r->max_c[2]);
  if (mask_bits(some >= 0) == 0) return;
#endif
  // Exact, as are the samples' offsets: multiples of 1/256 below 2^16.
  const float16 dx = (float)(r->dx + x * 256) * (1.0f / 256) + convert_float16(LANE_X),
                dy = (float)(r->dy + y * 256) * (1.0f / 256) + convert_float16(LANE_Y);
  int16 shown[SAMPLES];
  float16 depth[SAMPLES], before[SAMPLES];
  uint any = 0;
#pragma unroll
  for (int s = 0; s < SAMPLES; ++s) {
    const int16 sides =
        (gain[0] + r->sample_c[0][s]) | (gain[1] + r->sample_c[1][s]) | (gain[2] + r->sample_c[2][s]);
    depth[s] = lane_max(plane_depth(r, dx + SAMPLE_X(s), dy + SAMPLE_Y(s)), (float16)(r->z_min));
    before[s] = tile->depth[at][s];
    // Signed: RASTER_NONE is below every number.
    shown[s] = (sides >= 0) & (depth[s] >= before[s]) &
               ((depth[s] > before[s]) | ((int16)((int)r->triangle) > as_int16(tile->triangle[at][s])));
    any |= mask_bits(shown[s]);
  }
  if (any == 0) return;
#ifdef ALPHA_MASKS
  if (r->alpha_material >= 0) {
    int16 left[SAMPLES];
    for (int s = 0; s < SAMPLES; ++s) left[s] = shown[s];
    const MaskedTriangle masked =
        masked_triangle(&place->masks, r->triangle, r->instance, (uint)r->alpha_material,
                        (float)(place->pixel_x + x), (float)(place->pixel_y + y));
    apply_mask(&masked, BLOCK_DX, BLOCK_DY, left);
    show(r, at, left, depth, before, tile);
    return;
  }
#endif
  show(r, at, shown, depth, before, tile);
}

// The blocks of a square in which the triangle may show. Depths grow or fall steadily along x and y,
// rounding included: the depth at the corner where they are greatest bounds the block's.
static inline uint blocks_to_draw(const TileRecord* r, int square_x, int square_y, const Tile* tile) {
  const int x = square_x * 16, y = square_y * 16;
  const int16 across = LANE_X * 4, up = LANE_Y * 4;
  int16 sides = 0;
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    const Edge e = r->edges[k];
    // At each block's pixel that lies farthest inside.
    sides |= r->max_c[k] + edge_gain(e, x + (e.a > 0 ? 3 : 0), y + (e.b > 0 ? 3 : 0)) + r->in_block[k] * 4;
  }
  const int sample_x = r->zx > 0 ? max_gain(1, 0) : -max_gain(-1, 0),
            sample_y = r->zy > 0 ? max_gain(0, 1) : -max_gain(0, -1);
  const float16 depth = plane_depth(
      r, (float)(r->dx + x * 256 + sample_x) * (1.0f / 256) + convert_float16(across + (r->zx > 0 ? 3 : 0)),
      (float)(r->dy + y * 256 + sample_y) * (1.0f / 256) + convert_float16(up + (r->zy > 0 ? 3 : 0)));
  return mask_bits((sides >= 0) &
                   (lane_max(depth, (float16)(r->z_min)) >= tile->least[square_y * 4 + square_x]));
}

// Blocks [x0, x1] x [y0, y1] of the tile, of which there are few.
static inline bool few_are_hidden(float z_max, int x0, int y0, int x1, int y1, const Tile* tile) {
  const float* least = (const float*)tile->least;
  bool hidden = true;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) hidden &= z_max < least[block_place(x, y)];
  }
  return hidden;
}

static inline void draw_few(const TileRecord* r, int x0, int y0, int x1, int y1, const Place* place,
                            Tile* tile) {
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) draw_block(r, x, y, place, tile);
  }
}

static inline void draw_many(const TileRecord* r, int x0, int y0, int x1, int y1, const Place* place,
                             Tile* tile) {
  for (int square_y = y0 >> 2; square_y <= y1 >> 2; ++square_y) {
    for (int square_x = x0 >> 2; square_x <= x1 >> 2; ++square_x) {
      for (uint bits = blocks_to_draw(r, square_x, square_y, tile); bits != 0; bits &= bits - 1) {
        const int block = (int)lowest_bit(bits);
        draw_block(r, square_x * 4 + (block & 3), square_y * 4 + (block >> 2), place, tile);
      }
    }
  }
}

// The image is larger than the caches near the core, so its lines are not read first: a third of this
// kernel's time in Sponza at 1280 x 720.
#ifdef __clang__
typedef uint unaligned_row __attribute__((ext_vector_type(16), aligned(4)));
#define STORE_16(v, to) __builtin_nontemporal_store((unaligned_row)(v), (global unaligned_row*)(to))
#else
#define STORE_16(v, to) vstore16(v, 0, to)
#endif

// 16 values of a row, of which `count` lie in the image.
static inline void store_row(global uint* to, uint16 values, int count) {
  if (count >= 16) {
    STORE_16(values, to);
  } else {
    const uint* lanes = (const uint*)&values;
    for (int i = 0; i < count; ++i) to[i] = lanes[i];
  }
}

static inline uint16 shown_depth(const Tile* tile, uint block, int s) {
  return tile->triangle[block][s] == (uint16)(RASTER_NONE) ? (uint16)(0) : as_uint16(tile->depth[block][s]);
}

#if SAMPLES == 1
// Four rows of 16 pixels from four blocks side by side.
static inline void store_blocks(global uint* to, int width, const uint16* v, int columns, int rows) {
  const uint16 a = v[0], b = v[1], c = v[2], d = v[3];
  store_row(to, (uint16)(a.s0123, b.s0123, c.s0123, d.s0123), columns);
  if (rows > 1) store_row(to + width, (uint16)(a.s4567, b.s4567, c.s4567, d.s4567), columns);
  if (rows > 2) store_row(to + 2 * width, (uint16)(a.s89ab, b.s89ab, c.s89ab, d.s89ab), columns);
  if (rows > 3) store_row(to + 3 * width, (uint16)(a.scdef, b.scdef, c.scdef, d.scdef), columns);
}
#else
// The same, of SAMPLES values a pixel; v: block after block, those of each sample together.
static inline void store_blocks(global uint* to, int width, uint16* v, int columns, int rows) {
#pragma unroll
  for (int block = 0; block < 4; ++block) interleave(v + SAMPLES * block);
  for (int y = 0; y < min(rows, 4); ++y) {
    uint16 row[SAMPLES];  // its 16 pixels: a quarter from each block
#pragma unroll
    for (int i = 0; i < 4 * SAMPLES; ++i)
      ((uint4*)row)[i] = ((const uint4*)v)[i / SAMPLES * 4 * SAMPLES + y * SAMPLES + i % SAMPLES];
    for (int i = 0; i < SAMPLES; ++i)
      store_row(to + ((size_t)y * width) * SAMPLES + 16 * i, row[i], columns * SAMPLES - 16 * i);
  }
}
#endif

static inline void store_tile(const Tile* tile, int pixel_x, int pixel_y, global uint* triangles,
                              global float* depths, constant RasterParams* p) {
  const int width = (int)p->width, height = (int)p->height;
  for (int y = 0; y < RASTER_TILE && pixel_y + y < height; y += 4) {
    for (int x = 0; x < RASTER_TILE && pixel_x + x < width; x += 16) {
      const uint at = block_place(x >> 2, y >> 2);
      const size_t place = ((size_t)(pixel_y + y) * width + pixel_x + x) * SAMPLES;
      const int columns = width - pixel_x - x, rows = height - pixel_y - y;
      uint16 numbers[4 * SAMPLES], shown[4 * SAMPLES];
#pragma unroll
      for (int i = 0; i < 4 * SAMPLES; ++i) {
        const uint block = at + i / SAMPLES;
        numbers[i] = tile->triangle[block][i % SAMPLES];
        shown[i] = shown_depth(tile, block, i % SAMPLES);
      }
      store_blocks(triangles + place, width, numbers, columns, rows);
      store_blocks((global uint*)depths + place, width, shown, columns, rows);
    }
  }
}

// Inlined into the loop over tiles it is 3 to 5 % slower.
static __attribute__((noinline)) void draw_tile(uint number, global const RasterRecord* records,
                                                global const uint* tile_begin, global const uint* lists,
                                                MaskSource masks, global uint* triangles,
                                                global float* depths, constant RasterParams* p) {
  const int pixel_x = (int)(number % p->tiles_x) * RASTER_TILE,
            pixel_y = (int)(number / p->tiles_x) * RASTER_TILE;
  const Place place = {pixel_x, pixel_y, masks};
  Tile tile;
  for (uint i = 0; i < 256; ++i) {
    for (int s = 0; s < SAMPLES; ++s) {
      tile.depth[i][s] = LEAST_DEPTH;
      tile.triangle[i][s] = RASTER_NONE;
    }
  }
  for (uint i = 0; i < 16; ++i) tile.least[i] = LEAST_DEPTH;
  const uint end = tile_begin[number + 1];
  for (uint i = tile_begin[number]; i < end; ++i) {
    global const RasterRecord* record = records + lists[i];
    global const RasterRecord* later = records + lists[min(i + RECORDS_AHEAD, end - 1)];
    FETCH(later);
    FETCH(&later->alpha_material);  // in two cache lines
    const int last = RASTER_TILE - 1;
    const int x0 = max((int)(record->box_low & 0xffffu) - pixel_x, 0) >> 2;
    const int y0 = max((int)(record->box_low >> 16) - pixel_y, 0) >> 2;
    const int x1 = min((int)(record->box_high & 0xffffu) - pixel_x, last) >> 2;
    const int y1 = min((int)(record->box_high >> 16) - pixel_y, last) >> 2;
    const bool few = (x1 - x0 + 1) * (y1 - y0 + 1) <= FEW_BLOCKS;
    if (few && few_are_hidden(record->z_max, x0, y0, x1, y1, &tile)) continue;
    const TileRecord here = in_tile(record, pixel_x, pixel_y);
    if (few) {
      draw_few(&here, x0, y0, x1, y1, &place, &tile);
    } else {
      draw_many(&here, x0, y0, x1, y1, &place, &tile);
    }
  }
  store_tile(&tile, pixel_x, pixel_y, triangles, depths, p);
}

// A work-item takes the next tile that none has taken: PoCL hands out work-items in ranges, at first a thread's
// share of all of them, and some tiles take ten times as long as others.
kernel ONE_ITEM void raster_tiles(global const RasterRecord* records, global const uint* tile_begin,
                                  global const uint* lists, MASK_ARGUMENTS, global uint* triangles,
                                  global float* depths, global volatile uint* counters,
                                  constant RasterParams* p) {
  ASSUME_ONE_ITEM;
  if (counters[RASTER_BLOCKS] > p->record_blocks || counters[RASTER_ENTRIES + 1] != 0 ||
      counters[RASTER_ENTRIES] > p->entry_capacity) {
    return;
  }
  const uint tiles = p->tiles_x * p->tiles_y;
  const MaskSource masks = MASK_SOURCE(p);
  for (uint tile; (tile = atomic_inc(counters + RASTER_NEXT_TILE)) < tiles;)
    draw_tile(tile, records, tile_begin, lists, masks, triangles, depths, p);
}
