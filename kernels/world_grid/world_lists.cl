// The lists of each block's 64 cells, from the block's lights, 16 at a time. Runs twice: to test lights
// against cells, then, after world_scan, to write. A list is sorted because its block's lights are.
//
// lights   as in kernels/world_grid/world_block.h
// cones    axis and cosine of the outer half-angle, lowered as docs/hard_cases.md#slack says; null: no light
//          has one
// block_first, members, keys  of blocks; behind the members are 15 more that are numbers of lights
// masks    for each block and each BATCH of its lights 64 words, one a cell: a bit a light. Out, and with
//          `write` in
// totals   a chunk's number of entries out; with `write` its first entry in
// cells    out with `write`: 64 a block: first entry and number
// indices  out with `write`: entry_count
// counted, most  of world_counts_enough: counting then stops
// -DCOLUMNS   blocks are 8 x 8 columns, not 4 x 4 x 4 cubes
// -DINDEX_32  indices are 32 bits, not 16
#include "kernels/common/index_type.h"
#include "kernels/world_grid/world_block.h"

#ifdef INDEX_32
#define append_indices append_uints
#else
#define append_indices append_ushorts
#endif

#define BATCH 16u  // lights that are tested together: world_batch of world_grid/world_blocks.h

// Squared distances of lights from the cells along an axis. first: of their lanes in `sides`.
#define SQUARES_ALONG(at, sides, first, cells, squares)                      \
  _Pragma("unroll") for (uint i = 0; i < (cells); ++i) {                     \
    const float low = ((const float*)&(sides)->low)[(first) + i];            \
    const float high = ((const float*)&(sides)->high)[(first) + i];          \
    const real away = max_real(max_real(low - (at), (at)-high), REAL(0.0f)); \
    squares[i] = away * away;                                                \
  }

// Lights of a block are anywhere in memory: a batch is loaded at once, so that its cache misses overlap.
typedef struct Balls {
  real x, y, z, radius;
} Balls;

static inline Balls load_balls(global const float4* lights, global const uint* of) {
  const float16 a = (float16)(lights[of[0]], lights[of[1]], lights[of[2]], lights[of[3]]);
  const float16 b = (float16)(lights[of[4]], lights[of[5]], lights[of[6]], lights[of[7]]);
  const float16 c = (float16)(lights[of[8]], lights[of[9]], lights[of[10]], lights[of[11]]);
  const float16 d = (float16)(lights[of[12]], lights[of[13]], lights[of[14]], lights[of[15]]);
  const Balls balls = {
      (float16)(a.s048c, b.s048c, c.s048c, d.s048c), (float16)(a.s159d, b.s159d, c.s159d, d.s159d),
      (float16)(a.s26ae, b.s26ae, c.s26ae, d.s26ae), (float16)(a.s37bf, b.s37bf, c.s37bf, d.s37bf)};
  return balls;
}

// For each cell of the block the lights of a batch whose balls may reach it, a bit each. `masks` is volatile
// because LLVM 14 otherwise gathers words into vectors, which takes as long as the tests.
static inline void test_balls(Balls balls, uint batch, const BlockSides* sides,
                              volatile global ushort* masks) {
  real x[ALONG_X], y[ALONG_X], z[ALONG_Z];
  SQUARES_ALONG(balls.x, sides, 0, ALONG_X, x)
  SQUARES_ALONG(balls.y, sides, ALONG_X, ALONG_X, y)
#ifndef COLUMNS
  SQUARES_ALONG(balls.z, sides, 2 * ALONG_X, ALONG_Z, z)
#endif
  const real most = LANE_INDEX < (whole)((int)batch) ? balls.radius * balls.radius : REAL(-1.0f);
#pragma unroll
  for (uint i = 0; i < WORLD_BLOCK_CELLS; ++i) {
    const real across = x[i % ALONG_X] + y[i / ALONG_X % ALONG_X];
#ifdef COLUMNS
    masks[i] = (ushort)mask_bits(across <= most);
#else
    masks[i] = (ushort)mask_bits(across + z[i / (ALONG_X * ALONG_X)] <= most);
#endif
  }
}

#ifndef COLUMNS
// Removes lights from the cells that their cones miss. spots: a bit each.
static inline void test_cones(global const float4* lights, global const float4* cones,
                              global const uint* members, uint spots, const BlockSides* sides,
                              global ushort16* masks, constant WorldGridParams* world) {
  ushort16 met[PARTS];
  for (uint part = 0; part < PARTS; ++part) met[part] = masks[part];
  for (; spots != 0; spots &= spots - 1) {
    const uint i = lowest_bit(spots);
    const ConeTest test = cone_test(lights[members[i]], cones[members[i]], sides, world);
    const ushort16 others = (ushort16)(ushort) ~(1u << i);
#pragma unroll
    for (uint part = 0; part < PARTS; ++part)
      met[part] &= convert_ushort16(meets_cone(&test, sides, part)) | others;
  }
  for (uint part = 0; part < PARTS; ++part) masks[part] = met[part];
}
#endif

static inline uint bits_in(global const ulong8* masks, uint count) {
  ulong8 bits = 0;
  for (uint i = 0; i < count; ++i) bits += popcount(masks[i]);
  const ulong4 of_4 = bits.lo + bits.hi;
  return (uint)(of_4.x + of_4.y + of_4.z + of_4.w);
}

// Tests a block's lights. Returns the number of entries of its lists.
static inline uint test_lights(global const float4* lights, global const float4* cones,
                               global const uint* members, uint count, uint2 key, global ushort* masks,
                               constant WorldGridParams* world) {
  const BlockSides sides = block_sides(key, world);
  global ushort* at = masks;
  for (uint m = 0; m < count; m += BATCH, at += WORLD_BLOCK_CELLS) {
    const uint batch = min(count - m, BATCH);
    const Balls balls = load_balls(lights, members + m);
    test_balls(balls, batch, &sides, at);
#ifndef COLUMNS
    const uint spots = mask_bits((as_int16(balls.radius) & 1) != 0) & ((1u << batch) - 1u);
    if (spots != 0) test_cones(lights, cones, members + m, spots, &sides, (global ushort16*)at, world);
#endif
  }
  return bits_in((global const ulong8*)masks, (count + BATCH - 1) / BATCH * (WORLD_BLOCK_CELLS * 2 / 64));
}

// Writes the lights of one batch that `bits` has, in order. room: entries that may be written, kept or not.
static inline void write_batch(global const uint* members, uint bits, global index_t* indices, uint room) {
#if defined(AVX512) || defined(AVX2)
  if (room >= BATCH) {
    append_indices(indices, as_int16(vload16(0, members)), bits);
    return;
  }
#endif
  for (; bits != 0; bits &= bits - 1) *indices++ = (index_t)members[lowest_bit(bits)];
}

kernel void world_lists(global const float4* lights, global const float4* cones,
                        global const uint* block_first, global const uint* members, global const uint2* keys,
                        global ushort* masks, global uint* totals, global uint2* cells,
                        global index_t* indices, global volatile uint* counted, uint most, uint block_count,
                        uint chunk, uint write, uint entry_count, constant WorldGridParams* world) {
  const uint item = get_global_id(0);
  if ((ulong)item * chunk >= block_count) return;
  const uint block_end = min(item * chunk + chunk, block_count);
  uint at = write ? totals[item] : 0;
  const uint end = write && block_end < block_count ? totals[item + 1] : entry_count;
  for (uint block = item * chunk; block < block_end; ++block) {
    const uint first = block_first[block], count = block_first[block + 1] - first;
    global ushort* const own = masks + (size_t)(block + first / BATCH) * WORLD_BLOCK_CELLS;
    if (!write) {
      const uint listed = test_lights(lights, cones, members + first, count, keys[block], own, world);
      if (world_counts_enough(listed, &at, counted, most)) break;
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
