// The lists of each block's 64 cells, from the block's lights, 16 at a time. Runs twice: to test lights against cells, then,
// after world_scan, to write. A list is sorted because its block's lights are.
//
// lights   as in world_blocks; the radius of a light with a cone that is tested is an odd float, others' are even
// cones    axis and cosine of the outer half-angle, lowered as docs/hard_cases.md#slack says; null: no light has one
// block_first, members, keys  of blocks; members may be read 15 past their end
// masks    for each block and each BATCH of its lights 64 words, one a cell: a bit a light. Out, and with `write` in
// totals   a chunk's number of entries out; with `write` its first entry in
// cells    out with `write`: 64 a block: first entry and number
// indices  out with `write`: entry_count
// -DCOLUMNS   blocks are 8 x 8 columns, not 4 x 4 x 4 cubes
// -DINDEX_32  indices are 32 bits, not 16
// -DAVX512    with that instruction set's builtins
#define LANES 16
#include "kernels/common/pack.h"
#include "shared/world_grid.h"

#ifdef INDEX_32
typedef uint index_t;
#define append_indices append_uints
#else
typedef ushort index_t;
#define append_indices append_ushorts
#endif

#define PARTS (WORLD_BLOCK_CELLS / LANES)  // of a block, whose cells are tested together against a cone
#define BATCH 16u                          // lights that are tested together: WORLD_BATCH of renderer/world_grid.cpp

// Lower and upper sides of a block's cells along each axis, in lanes: cubes have 4 along x, then 4 along y
// and 4 along z; columns 8 along x, then 8 along y. The outer cells have no end.
typedef struct BlockSides {
  real low, high;
  float edge;
  mask_t outer[PARTS];                // cells without an end
  real x[PARTS], y[PARTS], z[PARTS];  // centres
} BlockSides;

// Of the cells of one part, from lanes as above.
#ifdef COLUMNS
#define SPREAD_X(v) (v).s0123456701234567
#define SPREAD_Y(v, part)                \
  ((part) == 0   ? (v).s8888888899999999 \
   : (part) == 1 ? (v).saaaaaaaabbbbbbbb \
   : (part) == 2 ? (v).sccccccccdddddddd \
                 : (v).seeeeeeeeffffffff)
#define ALONG_X 8
#define ALONG_Z 1
#else
#define SPREAD_X(v) (v).s0123012301230123
#define SPREAD_Y(v, part) (v).s4444555566667777
#define ALONG_X 4
#define ALONG_Z 4
#endif
#define SPREAD_Z(v, part) ((part) == 0 ? (v).s8 : (part) == 1 ? (v).s9 : (part) == 2 ? (v).sa : (v).sb)

static inline BlockSides block_sides(uint2 key, constant WorldGridParams* world) {
  const uint level = key.y >> 16, x0 = (key.x & 0xffffu) << world->shift_x,
             y0 = key.x >> 16 << world->shift_y;
  const uint z0 = (key.y & 0xffffu) << world->shift_z;
  const whole of_x = LANE_INDEX + (int)x0;
  const whole of_y = (LANE_INDEX & (ALONG_X - 1)) + (int)y0, of_z = (LANE_INDEX & 3) + (int)z0;
  const mask_t is_x = LANE_INDEX < (whole)(ALONG_X), is_z = LANE_INDEX >= (whole)(2 * ALONG_X);
  const whole cell = is_x ? of_x : is_z ? of_z : of_y;
  const whole cells = is_x   ? (whole)((int)world->cells_x)
                      : is_z ? (whole)((int)world->cells_z)
                             : (whole)((int)world->cells_y);
  const real least = is_x ? REAL(world->least_x) : is_z ? REAL(world->least_z) : REAL(world->least_y);
  const mask_t first = cell == 0, last = (cell + 1) << (int)level >= cells;
  const real low = TO_REAL(cell << (int)level) + least, high = TO_REAL((cell + 1) << (int)level) + least;
  BlockSides s;
  s.low = first ? REAL(-INFINITY) : low, s.high = last ? REAL(INFINITY) : high;
  s.edge = (float)(1u << level);
  const real centre = low + 0.5f * s.edge;
  const mask_t outer = first | last;
  for (uint part = 0; part < PARTS; ++part) {
    s.x[part] = SPREAD_X(centre), s.y[part] = SPREAD_Y(centre, part), s.z[part] = SPREAD_Z(centre, part);
    s.outer[part] = SPREAD_X(outer) | SPREAD_Y(outer, part) | (mask_t)(SPREAD_Z(outer, part));
  }
  return s;
}

// Whether a cone may reach the balls around cells, `radius` and slack large. The distance from the axis is
// that of a difference, whose rounding is relative to the distance from the apex even next to the axis.
static inline mask_t meets_cone(float4 light, float4 cone, const BlockSides* s, uint part, float radius) {
  const real x = s->x[part] - light.x, y = s->y[part] - light.y, z = s->z[part] - light.z;
  const real along = x * cone.x + y * cone.y + z * cone.z;
  const real off_x = x - along * cone.x, off_y = y - along * cone.y, off_z = z - along * cone.z;
  const real most = radius + sqrt((1.0f - cone.w) * (1.0f + cone.w)) * along;
  const real off = cone.w * cone.w * (off_x * off_x + off_y * off_y + off_z * off_z);
  return s->outer[part] | ((most >= REAL(0.0f)) & (off <= most * most));
}

// Squared distances of lights from the cells along an axis; `first` is the number of those before them in `sides`.
static inline void squares_along(real at, const BlockSides* sides, uint first, uint cells, real* squares) {
  for (uint i = 0; i < cells; ++i) {
    const float low = ((const float*)&sides->low)[first + i], high = ((const float*)&sides->high)[first + i];
    const real away = max_real(max_real(low - at, at - high), REAL(0.0f));
    squares[i] = away * away;
  }
}

// Lights of a block are anywhere in memory: a batch is loaded at once, so that its cache misses overlap.
typedef struct Balls {
  real x, y, z, radius;
} Balls;

#ifdef AVX512
#define GATHERED(component)                                                                                         \
  __builtin_ia32_gathersiv16sf((real)(0.0f), (const void*)((size_t)lights + 4 * (component)), of * 2, (ushort)0xffff, 8)
static inline Balls load_balls(global const float4* lights, whole of) {
  const Balls b = {GATHERED(0), GATHERED(1), GATHERED(2), GATHERED(3)};
  return b;
}
#else
static inline Balls load_balls(global const float4* lights, whole of) {
  float x[BATCH], y[BATCH], z[BATCH], radius[BATCH];
  for (uint i = 0; i < BATCH; ++i) {
    const float4 light = lights[((const int*)&of)[i]];
    x[i] = light.x, y[i] = light.y, z[i] = light.z, radius[i] = light.w;
  }
  const Balls b = {vload16(0, x), vload16(0, y), vload16(0, z), vload16(0, radius)};
  return b;
}
#endif

// For each cell of the block the lights of a batch whose balls may reach it, a bit each.
static inline void test_balls(Balls balls, uint valid, const BlockSides* sides, ushort* met) {
  real x[ALONG_X], y[ALONG_X], z[ALONG_Z];
  squares_along(balls.x, sides, 0, ALONG_X, x);
  squares_along(balls.y, sides, ALONG_X, ALONG_X, y);
#ifndef COLUMNS
  squares_along(balls.z, sides, 2 * ALONG_X, ALONG_Z, z);
#endif
  const real most = balls.radius * balls.radius;
#pragma unroll
  for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) {
    const real across = x[i % ALONG_X] + y[i / ALONG_X % ALONG_X];
#ifdef COLUMNS
    met[i] = (ushort)(mask_bits(across <= most) & valid);
#else
    met[i] = (ushort)(mask_bits(across + z[i / (ALONG_X * ALONG_X)] <= most) & valid);
#endif
  }
}

// Removes a light from the cells that its cone misses.
static inline void test_cone(float4 light, float4 axis, uint lane, const BlockSides* sides, ushort* met,
                             constant WorldGridParams* world) {
  // The ball around a cell, rounded up, and slack for both the light and the test's own rounding.
  const float far = fabs(light.x) + fabs(light.y) + fabs(light.z);
  const float radius = 0.866026f * sides->edge + 2.0f * world_slack(far, light.w, world);
  const ushort bit = (ushort)(1u << lane);
  for (uint part = 0; part < PARTS; ++part) {
    const mask_t meets = meets_cone(light, axis, sides, part, radius);
    const ushort16 of_cells = vload16(part, met);
    vstore16(of_cells & (convert_ushort16(meets) | (ushort16)(ushort)~bit), part, met);
  }
}

// Tests a block's lights. Returns the number of entries of its lists.
static inline uint test_lights(global const float4* lights, global const float4* cones, global const uint* members,
                               uint count, uint2 key, global ushort* masks, constant WorldGridParams* world) {
  const BlockSides sides = block_sides(key, world);
  uint entries = 0;
  for (uint m = 0; m < count; m += BATCH, masks += WORLD_BLOCK_CELLS) {
    const uint batch = min(count - m, BATCH), valid = (1u << batch) - 1u;
    const whole last = (whole)(members[m + batch - 1]);
    const whole of = LANE_INDEX < (whole)((int)batch) ? as_int16(vload16(0, members + m)) : last;
    ushort met[WORLD_BLOCK_CELLS];
    const Balls balls = load_balls(lights, of);
    test_balls(balls, valid, &sides, met);
    uint spots = mask_bits((as_int16(balls.radius) & 1) != 0) & valid;
    for (; spots != 0; spots &= spots - 1) {
      const uint i = lowest_bit(spots);
      test_cone(lights[members[m + i]], cones[members[m + i]], i, &sides, met, world);
    }
    for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) masks[i] = met[i], entries += popcount((uint)met[i]);
  }
  return entries;
}

// Writes the lights of one batch that `bits` has, in order. room: entries that may be written, kept or not.
static inline void write_batch(global const uint* members, uint bits, global index_t* indices, uint room) {
#ifdef AVX512
  if (room >= BATCH) {
    append_indices(indices, as_int16(vload16(0, members)), bits);
    return;
  }
#endif
  for (; bits != 0; bits &= bits - 1) *indices++ = (index_t)members[lowest_bit(bits)];
}

kernel void world_lists(global const float4* lights, global const float4* cones, global const uint* block_first,
                        global const uint* members, global const uint2* keys, global ushort* masks, global uint* totals,
                        global uint2* cells, global index_t* indices, uint block_count, uint chunk, uint write,
                        uint entry_count, constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= block_count) return;
  const uint block_end = min(item * chunk + chunk, block_count);
  uint at = write ? totals[item] : 0;
  const uint end = write && block_end < block_count ? totals[item + 1] : entry_count;
  for (uint block = item * chunk; block < block_end; ++block) {
    const uint first = block_first[block], count = block_first[block + 1] - first;
    global ushort* const own = masks + (size_t)(block + first / BATCH) * WORLD_BLOCK_CELLS;
    if (!write) {
      at += test_lights(lights, cones, members + first, count, keys[block], own, world);
      continue;
    }
    for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) {
      const uint list = at;
      for (uint batch = 0; batch * BATCH < count; ++batch) {
        const uint bits = own[batch * WORLD_BLOCK_CELLS + i];
        write_batch(members + first + batch * BATCH, bits, indices + at, end - at);
        at += popcount(bits);
      }
      cells[(size_t)block * WORLD_BLOCK_CELLS + i] = (uint2)(list, at - list);
    }
  }
  if (!write) totals[item] = at;
}
